#include "common/record/sniff.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

#include "common/record/cell_sorting.h"
#include "common/record/recording_stream.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLooked = 64 * 1024;  // bytes at the beginning of a file
constexpr std::string_view kMcap = "\x89MCAP";

/// Files that begin with certain bytes.
struct Magic {
  std::size_t at;
  std::string_view bytes;
  std::string_view format;
  std::string_view what;
  std::string_view remedy;
};

constexpr std::string_view kFromIts = "export the joints from its program as BVH, C3D or csv";
// clang-format off
constexpr Magic kMagics[] = {
    {4, "ftypheic", "", "a photo (HEIC)", "heif-convert makes a JPEG of it"},
    {4, "ftypmif1", "", "a photo (HEIF)", "heif-convert makes a JPEG of it"},
    {4, "ftyp", "video", "a video (MP4 or MOV)", "chorus import video reads it"},
    {8, "AVI ", "video", "a video (AVI)", "chorus import video reads it"},
    {0, "\x1A\x45\xDF\xA3", "video", "a video (Matroska or WebM)", "chorus import video reads it"},
    {0, "\x1F\x8B", "", "packed with gzip", "gunzip it first"},
    {0, "\x28\xB5\x2F\xFD", "", "packed with zstd", "unzstd it first"},
    {0, "BZh", "", "packed with bzip2", "bunzip2 it first"},
    {0, "\xFD" "7zXZ", "", "packed with xz", "unxz it first"},
    {0, "7z\xBC\xAF", "", "packed with 7-Zip", "unpack it first"},
    {0, "PK\x03\x04", "", "a ZIP archive (as xlsx and npz are, too)", "unpack it, or save the table as csv"},
    {0, "Kaydara FBX", "", "a scene (FBX)", "convert it to BVH, which Blender does: File, Import FBX; File, Export BVH"},
    {0, "glTF", "", "a scene (glTF)", "convert it to BVH, which Blender does"},
    {0, "BLENDER", "", "a Blender file", "File, Export, Motion Capture (.bvh)"},
    {0, "#ROSBAG", "", "a ROS 1 bag", "Chorus reads no ROS messages: write the joints as csv"},
    {0, "SQLite format 3", "", "an SQLite database, as bags of ROS 2 are", "Chorus reads no ROS messages: write the joints as csv"},
    {0, "\x89HDF", "", "an HDF5 file", "write the joints as csv"},
    {0, "MATLAB 5.0", "", "a MATLAB file", "write the joints as csv (writetable)"},
    {0, "\x93NUMPY", "", "a numpy array", "write the joints as csv"},
    {0, "\xFF\xD8\xFF", "", "a photo (JPEG)", "videos, not photos, are imported; chorus calibrate camera reads photos"},
    {0, "\x89PNG", "", "a picture (PNG)", "videos, not pictures, are imported"},
    {0, "%PDF", "", "a document (PDF)", ""},
    {0, "version https://git-lfs", "", "a pointer of Git LFS instead of the file", "git lfs pull fetches the file"},
    {0, "HIERARCHY", "bvh", "a BVH file", "chorus import bvh reads it"},
    {0, "PathFileType", "trc", "a TRC file", "chorus import trc reads it"},
    {0, ":version", "", "a skeleton (ASF) of Acclaim", "convert it to BVH; for the simulator name the .amc"},
    {0, ":FULLY-SPECIFIED", "", "a motion (AMC) of Acclaim", "convert it to BVH; for the simulator name it as it is"},
    {0, "NO_OF_FRAMES", "", "a table (TSV) of Qualisys", "export C3D from QTM instead"},
    {0, "Format Version,", "", "a take (csv) of Motive", "export C3D or BVH from Motive instead"},
    {0, "<!DOCTYPE", "", "a web page instead of the file", "download the file itself"},
    {0, "<html", "", "a web page instead of the file", "download the file itself"},
};

/// Texts that hold certain words.
struct Words {
  std::string_view begins;  ///< After blanks; "" if it does not matter.
  std::array<std::string_view, 3> holds;
  std::string_view format;
  std::string_view what;
  std::string_view remedy;
};
constexpr Words kWords[] = {
    {"<", {"<mvnx"}, "mvnx", "an MVNX file", "chorus import mvnx reads it"},
    {"<", {"<?xml"}, "", "an XML file of another kind", kFromIts},
    {"", {"[Header]", "EulerRotationOrder"}, "htr", "an HTR file of Motion Analysis", "chorus import htr reads it"},
    {"", {"DataType=Quaternion", "endheader", "time"}, "inertial", "a table (.sto) of OpenSim with orientations", "chorus import inertial reads it"},
    {"", {"endheader", "time"}, "", "a table (.mot, .sto) of OpenSim with angles, without places of joints", "export the markers as TRC"},
    {"{", {"\"@type\"", "\"Frame\"", "\"bodies\""}, "ndjson", "frames of Chorus in lines", "chorus import ndjson reads it"},
    {"{", {"\"schemaVersion\"", "\"master\""}, "", "a registration of Chorus", "chorus fuse takes it as --registration"},
    {"{", {"\"people\""}, "openpose", "landmarks in OpenPose's form", "chorus import openpose reads it, with the lens of the camera (--intrinsics)"},
    {"", {"\"image_id\"", "\"keypoints\""}, "openpose", "landmarks in COCO's or AlphaPose's form", "chorus import openpose reads it, with the lens of the camera (--intrinsics)"},
    {"", {"\"keypoint_scores\""}, "mmpose", "landmarks in MMPose's form", "chorus import mmpose reads it, with the lens of the camera (--intrinsics)"},
    {"{", {"\"fx\"", "\"cx\""}, "", "the lens of a camera", "it belongs to --intrinsics"},
    {"", {"PELVIS (x)", "timestamp"}, "azure-kinect", "PyMoCapViewer's csv", "chorus import azure-kinect reads it"},
    {"", {"joint", "x_m", "y_m"}, "csv", "joints in columns", "chorus import csv reads it"},
};
// clang-format on

std::string lower_of(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_c3d(std::string_view bytes) {
  return bytes.size() > 512 && bytes[1] == 0x50 && bytes[0] >= 2 && bytes[0] <= 32;
}

bool matches(const Words& row, std::string_view text) {
  if (!text.starts_with(row.begins)) return false;
  return std::ranges::all_of(row.holds, [&](std::string_view word) {
    return word.empty() || text.find(word) != std::string_view::npos;
  });
}

std::string topics_of(const std::vector<Channel>& channels) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, channels.size()); ++i)
    text += (i == 0 ? "" : ", ") + channels[i].topic.substr(0, 40) + " (" +
            channels[i].schema_name.substr(0, 40) + ")";
  return channels.size() > kShown ? text + ", ..." : text;
}

bool is_ours(const Channel& channel) {
  return channel.schema_name.starts_with("chorus.") || channel.topic.starts_with(kSensorsPrefix);
}

/// A recording whose compression or messages are not ours; "a recording" if nothing is wrong.
Sniffed sniff_recording(const fs::path& path) {
  auto stream = RecordingStream::open(path);
  if (!stream) return {"", "a recording (MCAP) that cannot be read: " + stream.error().message, ""};
  const auto first = stream->next();
  const auto channels = stream->channels();
  const auto packed = std::ranges::find_if(stream->notes(), [](const std::string& note) {
    return note.find("compression") != std::string::npos;
  });
  if (packed != stream->notes().end() && (!first || !*first))
    return {"", "a recording (MCAP) packed in a way that is not read (" + *packed + ")",
            "repack it: mcap compress --compression zstd IN.mcap -o OUT.mcap"};
  if (channels.empty()) return {"", "a recording (MCAP) without messages", ""};
  if (std::ranges::none_of(channels, is_ours))
    return {"", "a recording (MCAP) that holds " + topics_of(channels) + ", nothing of Chorus",
            "write the joints as csv, which chorus import csv reads"};
  const bool raw = std::ranges::any_of(channels, [](const Channel& channel) {
    const auto topic = topic_of(channel.topic);
    return topic && topic->sensor && topic->what == "frame";
  });
  if (!raw && stream->metadata().empty())
    return {"recording", "a recording with fused frames alone",
            "it was recorded with --fused alone: chorus export reads it; to fuse or replay, record "
            "with raw frames"};
  return {"recording", "a recording of Chorus", "chorus fuse and chorus replay read it"};
}

Sniffed sniff_folder(const fs::path& path) {
  std::map<std::string, std::size_t> endings;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(path, failed)) {
    if (entry.path().filename() == "cameras.json")
      return {"pose2sim", "a folder with cameras.json", "chorus import pose2sim reads it"};
    ++endings[lower_of(entry.path().extension().string())];
  }
  if (endings.empty()) return {"", "an empty folder", ""};
  for (const auto& [ending, format, remedy] :
       {std::tuple{".mcap", "recording", "chorus fuse and chorus replay read it"},
        std::tuple{".json", "openpose",
                   "chorus import openpose or mmpose read the folder of one camera each"},
        std::tuple{".mp4", "video", "name the videos in it to chorus import video"}}) {
    if (endings.contains(ending))
      return {format, "a folder with " + std::to_string(endings[ending]) + " files " + ending,
              remedy};
  }
  return {"", "a folder with files " + endings.begin()->first + " and no recording",
          "name the files in it"};
}

}  // namespace

Sniffed sniff_bytes(std::string_view bytes) {
  if (bytes.empty()) return {"", "an empty file", ""};
  const auto of = [](const auto& row) {
    return Sniffed{std::string(row.format), std::string(row.what), std::string(row.remedy)};
  };
  for (const Magic& row : kMagics) {
    if (bytes.size() > row.at && bytes.substr(row.at).starts_with(row.bytes)) return of(row);
  }
  if (is_c3d(bytes)) return {"c3d", "a C3D file", "chorus import c3d reads it"};
  std::string_view text = bytes;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const Words& row : kWords) {
    if (matches(row, text)) return of(row);
  }
  for (const Magic& row : kMagics) {
    if (row.at == 0 && lower_of(text.substr(0, row.bytes.size())) == lower_of(row.bytes))
      return of(row);
  }
  return {};
}

Sniffed sniff(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) return sniff_folder(path);
  if (!fs::is_regular_file(path, failed)) return {};
  std::string bytes(kLooked, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes.starts_with(kMcap) ? sniff_recording(path) : sniff_bytes(bytes);
}

Error with_sniffed(Error error, std::span<const fs::path> inputs, std::string_view expected) {
  for (const fs::path& input : inputs) {
    const Sniffed found = sniff(input);
    const bool fits = found.format == expected && !found.remedy.starts_with("it was recorded");
    if (found.what.empty() || fits) continue;
    while (error.message.ends_with('.')) error.message.pop_back();
    error.message += "; " + input.filename().string() + " is " + found.what;
    if (!found.remedy.empty()) error.message += ": " + found.remedy;
    return error;
  }
  return error;
}

}  // namespace chorus::record
