// Precision, recall and F of detected errors against annotated ones (Baak et al., 4), frame by
// frame and segment by segment, and how far two annotators agree.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/limb_error.h"
#include "common/inertial/limb.h"

namespace chorus::evaluation {

struct Counts {
  double true_positives = 0.0;
  double false_positives = 0.0;
  double false_negatives = 0.0;
  double true_negatives = 0.0;  ///< Of frames; segments have none.

  Counts& operator+=(const Counts& other);
  /// Nothing where nothing was detected (precision) or annotated (recall).
  [[nodiscard]] std::optional<double> precision() const;
  [[nodiscard]] std::optional<double> recall() const;
  [[nodiscard]] std::optional<double> f() const;
};

/// Each time is a frame: detected, annotated, both or neither.
[[nodiscard]] Counts frame_counts(const std::vector<double>& times,
                                  const std::vector<Segment>& detected,
                                  const std::vector<Segment>& annotated);

/// A detected segment is right if it shares at least `least_overlap` of its union with an annotated
/// one (the paper: "segment-based [...] values may be a more suitable measure").
[[nodiscard]] Counts segment_counts(const std::vector<Segment>& detected,
                                    const std::vector<Segment>& annotated,
                                    double least_overlap = 0.3);

/// Cohen's kappa of two annotators over the same frames: 1 agree, 0 as if by chance.  Nothing if
/// there are no frames or both say the same everywhere.
[[nodiscard]] std::optional<double> kappa(const std::vector<double>& times,
                                          const std::vector<Segment>& one,
                                          const std::vector<Segment>& other);

/// Area under the ROC curve of a quantity that should be larger inside the segments: the chance
/// that it is larger in a random frame inside than in one outside.  Nothing if one side is empty.
[[nodiscard]] std::optional<double> roc_area(const std::vector<Timed<double>>& values,
                                             const std::vector<Segment>& segments);

/// True if the time lies in a segment, ends included.
[[nodiscard]] bool inside(const std::vector<Segment>& segments, double time);

/// What one annotator saw: segments of tracking errors for each limb.
struct Annotation {
  inertial::Limb limb = inertial::Limb::Pelvis;
  Segment segment;
};

/// A csv file with a head line and the columns limb, begin_s, end_s (seconds after the take's first
/// frame); limbs by the names of limb.h.  Refuses, with the line, what it cannot read.
[[nodiscard]] Result<std::vector<Annotation>> parse_annotations(std::string_view text,
                                                                std::string_view origin);
[[nodiscard]] std::vector<Segment> segments_of(const std::vector<Annotation>& all,
                                               inertial::Limb limb);

}  // namespace chorus::evaluation
