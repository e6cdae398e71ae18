// TRC: the marker table of Motion Analysis, as OpenSim reads it.  Tabs, three columns per marker,
// mm.
//
// Rows: the file type; the names of the file's properties; their values; the names of the markers;
// X1 Y1 Z1 ...; an empty row; then rows of frame number, seconds since the start, and coordinates.
// Missing joints are empty fields.  For several persons the markers are called P1_Head, P2_Head,
// ...  +y is up, as in OpenSim.
#pragma once

#include <string>
#include <string_view>

#include "common/exporters/column_names.h"
#include "common/exporters/take.h"

namespace chorus::exporters {

/// `file_name` appears in the first row.  Names of Pose2Sim: its markers alone; of Motive: as of
/// Chorus, because a marker is no bone.
[[nodiscard]] std::string trc_of(const Take& take, std::string_view file_name,
                                 ColumnNames names = ColumnNames::Chorus);

}  // namespace chorus::exporters
