#include "common/exporters/export_formats.h"

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/bvh.h"
#include "common/exporters/c3d.h"
#include "common/exporters/csv.h"
#include "common/exporters/gltf.h"
#include "common/exporters/joint_angles.h"
#include "common/exporters/number_text.h"
#include "common/exporters/sto.h"
#include "common/exporters/trc.h"
#include "common/exporters/wide_csv.h"

namespace chorus::exporters {
namespace {

std::string remark_on(const SkeletonFit& fit, const Take& take) {
  std::string text =
      "person " + std::to_string(fit.person.value) + ": bones of constant length are ";
  append_fixed(text, to_mm(fit.residual.rms), 1);
  text += " mm (rms) from the fused joints, at most ";
  append_fixed(text, to_mm(fit.residual.largest), 1);
  text += " mm (" + std::string(name_of(fit.residual.joint)) + ", ";
  append_fixed(text, static_cast<double>(fit.residual.frame) / take.rate_hz, 2);
  return text + " s)";
}

Result<Exported> skeletal(const Take& take, ExportFormat format, const ExportOptions& options) {
  Exported out;
  std::vector<SkeletonFit> fits;
  for (const PersonTrack& track : take.persons) {
    auto fit = fit_skeleton(track);
    if (!fit && take.persons.size() == 1) return pass(fit);
    if (!fit) {
      out.remarks.push_back("left out: " + to_string(fit.error()));
      continue;
    }
    out.remarks.push_back(remark_on(*fit, take));
    fits.push_back(std::move(*fit));
  }
  if (fits.empty())
    return fail(ErrorCode::Unsupported, "fused frames", "nobody in them shows a SpineBase.");
  if (format == ExportFormat::Gltf) {
    out.files.push_back({"", gltf_of(fits, take.rate_hz)});
    return out;
  }
  for (const SkeletonFit& fit : fits) {
    const std::string suffix =
        take.persons.size() > 1 ? "-p" + std::to_string(fit.person.value) : "";
    out.files.push_back({suffix, bvh_of(fit, take.rate_hz, {options.units_per_metre})});
  }
  return out;
}

/// A table for each person, where `table_of` can make one.
Result<Exported> tables_of(const Take& take,
                           Result<std::string> (*table_of)(const PersonTrack&, double)) {
  Exported out;
  for (const PersonTrack& track : take.persons) {
    auto table = table_of(track, take.rate_hz);
    if (!table && take.persons.size() == 1) return pass(table);
    if (!table) {
      out.remarks.push_back("left out: " + to_string(table.error()));
      continue;
    }
    const std::string suffix =
        take.persons.size() > 1 ? "-p" + std::to_string(track.person.value) : "";
    out.files.push_back({suffix, std::move(*table)});
  }
  if (!out.files.empty()) return out;
  return fail(ErrorCode::Unsupported, "fused frames",
              "show nobody of whom such a table can be made");
}

Result<Exported> table_in_csv(const Take& take, const ExportOptions& options) {
  if (!options.wide) return Exported{{{"", csv_of(take)}}, {}};
  auto text = wide_csv_of(take, options.columns, options.file_name);
  if (!text) return pass(text);
  return Exported{{{"", std::move(*text)}}, {}};
}

}  // namespace

Result<Exported> exported(const Take& take, ExportFormat format, const ExportOptions& options) {
  switch (format) {
    case ExportFormat::Bvh:
    case ExportFormat::Gltf:
      return skeletal(take, format, options);
    case ExportFormat::Trc:
      return Exported{{{"", trc_of(take, options.file_name, options.columns)}}, {}};
    case ExportFormat::Csv:
      return table_in_csv(take, options);
    case ExportFormat::Sto:
      return tables_of(take, &sto_of);
    case ExportFormat::Mot:
      return tables_of(take, &mot_of);
    case ExportFormat::AnglesCsv:
      return Exported{{{"", angles_csv_of(take)}}, {}};
    case ExportFormat::C3d:
      break;
  }
  auto bytes = c3d_of(take);
  if (!bytes) return pass(bytes);
  return Exported{{{"", std::move(*bytes)}}, {}};
}

}  // namespace chorus::exporters
