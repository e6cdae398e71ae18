// The table of all export formats, for `chorus export`.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/exporters/column_names.h"
#include "common/exporters/take.h"

namespace chorus::exporters {

enum class ExportFormat { Bvh, C3d, Trc, Csv, Gltf, Sto, AnglesCsv, Mot };

struct ExportRow {
  ExportFormat format;
  std::string_view name;    ///< Its name on the command line.
  std::string_view writes;  ///< One line for --help.
};

inline constexpr std::array<ExportRow, 8> kExportFormats{{
    {ExportFormat::Bvh, "bvh", "hierarchy and rotations, one file a person"},
    {ExportFormat::C3d, "c3d", "points, float, millimetres, missing joints marked"},
    {ExportFormat::Trc, "trc", "points as a table, as OpenSim reads it"},
    {ExportFormat::Csv, "csv", "one row a joint, with states and deviations; --wide: one a frame"},
    {ExportFormat::Gltf, "gltf", "animated skinned skeletons, binary (.glb)"},
    {ExportFormat::Sto, "sto", "orientations of limbs as a table, as OpenSense reads it"},
    {ExportFormat::AnglesCsv, "angles-csv", "ISB joint angles with deviations, one row a frame"},
    {ExportFormat::Mot, "mot", "joint angles as coordinates of OpenSim's models"},
}};

struct ExportOptions {
  std::string file_name = "chorus";           ///< For TRC and Motive's CSV: without its folder.
  double units_per_metre = 100.0;             ///< For BVH.
  bool wide = false;                          ///< For CSV: a row a frame (wide_csv.h).
  ColumnNames columns = ColumnNames::Chorus;  ///< For TRC and wide CSV.
};

struct ExportedFile {
  std::string suffix;  ///< "" or "-p3"; goes before the file extension.
  std::string bytes;
};

struct Exported {
  std::vector<ExportedFile> files;
  std::vector<std::string> remarks;  ///< For people: how well bones of constant length fit, and who
                                     ///< was left out.
};

/// Several files result only if the format holds a single person and the take has several.
[[nodiscard]] Result<Exported> exported(const Take& take, ExportFormat format,
                                        const ExportOptions& options = {});

}  // namespace chorus::exporters
