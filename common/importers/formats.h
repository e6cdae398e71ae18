// The table of all formats, and the import of whole sets of files, for `chorus import`.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/importers/camera_views.h"
#include "common/importers/file_space.h"
#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

enum class FileFormat {
  Labanotation,
  Ntu,
  NwUcla,
  Keraal,
  Pose2Sim,
  C3d,
  Trc,
  Bvh,
  Htr,
  Mvnx,
  Csv,
  Ndjson,
  AzureKinect
};

struct FormatRow {
  FileFormat format;
  std::string_view name;   ///< Its name on the command line.
  std::string_view reads;  ///< One line for --help.
};

inline constexpr std::array<FormatRow, 13> kFormats{{
    {FileFormat::Labanotation, "labanotation",
     "LabanotationSuite csv, Kinect v2 with capture times"},
    {FileFormat::Ntu, "ntu", "NTU RGB+D .skeleton, Kinect v2, 30 Hz assumed"},
    {FileFormat::NwUcla, "nw-ucla", "Northwestern-UCLA json, Kinect v1, 30 Hz assumed"},
    {FileFormat::Keraal, "keraal", "KERAAL Kinect text, Kinect v2, 30 Hz assumed"},
    {FileFormat::Pose2Sim, "pose2sim", "a folder of camera landmarks with cameras.json"},
    {FileFormat::C3d, "c3d", "C3D, points named as joints, joint centres or markers; as truth"},
    {FileFormat::Trc, "trc", "TRC of OpenSim, Pose2Sim and others, named points; as truth"},
    {FileFormat::Bvh, "bvh", "Biovision BVH, the usual joint names; as truth"},
    {FileFormat::Htr, "htr", "Motion Analysis HTR, the usual joint names; as truth"},
    {FileFormat::Mvnx, "mvnx", "Xsens MVN XML; as truth"},
    {FileFormat::Csv, "csv", "joints in columns, also those that chorus export writes"},
    {FileFormat::Ndjson, "ndjson", "/frame documents in lines, also those that chorus fuse writes"},
    {FileFormat::AzureKinect, "azure-kinect", "PyMoCapViewer csv, Azure Kinect, 32 landmarks"},
}};

[[nodiscard]] std::optional<FileFormat> format_named(std::string_view name);

struct ImportedSet {
  /// One per sensor, in the order of the inputs.
  std::vector<record::FrameRecording> recordings;
  std::map<SensorId, Eigen::Isometry3d> world_from_sensor;  ///< Published extrinsics, if any.
  std::vector<TruthFrame> truth;                            ///< Published truth, if any.
  FileSpaces spaces = {};         ///< How the files' coordinates became ours.
  std::vector<Error> empty = {};  ///< Inputs without frames, which were left out.
};

/// Reads a set of files.  Usually each input is one sensor.  For pose2sim the only input is the
/// folder.  For c3d, bvh, htr and mvnx, and for a single csv or ndjson file without a floor, the
/// only input is a file whose world becomes ours (motion_file.h).  Refuses sets in which two inputs
/// would be the same sensor or have the same numbers, and people of an impossible size.  The notes
/// of every recording say when the set begins and how long it lasts (set_origin, set_period_ns), so
/// that several replays stay in step when they loop.  If files count from the start of one sensor,
/// the time between them is kept.
[[nodiscard]] Result<ImportedSet> import_files(FileFormat format,
                                               const std::vector<std::filesystem::path>& inputs,
                                               const ImportOptions& options = {});

/// Reads `file`, the input with this index; `options.floor` is the floor of this input.
using ReadRecording = std::function<Result<record::FrameRecording>(
    const std::filesystem::path& file, const ImportOptions& options, std::size_t index)>;

/// Like import_files(), but the caller's function reads each file, one sensor per file, in metres;
/// options.up is applied here.  `metres_per_unit` is that of the files, for what is said about
/// them.
[[nodiscard]] Result<ImportedSet> import_recordings(
    const std::vector<std::filesystem::path>& inputs, const ImportOptions& options,
    const ReadRecording& read, double metres_per_unit = 1.0);

}  // namespace chorus::importers
