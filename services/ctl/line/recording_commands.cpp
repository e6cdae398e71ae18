// The commands that work on recordings and pictures.
#include <array>

#include "services/ctl/line/command.h"

namespace chorus::ctl {
namespace {

constexpr std::array kRecordingCommands{
    Command{"import", "Turns other people's recordings into ours, one .mcap per sensor",
            "Examples:\n"
            "  chorus import labanotation Ges01.csv --out rec --floor 0,0.99,0.12,1.1\n"
            "  chorus import pose2sim tests/data/pose2sim_mediapipe --out rec\n"
            "  chorus import nw-ucla a04_s01_e00_v0*.json --out rec --start 2026-11-21T07:30:00Z\n"
            "  chorus import openpose cam01_json cam02_json --out rec --intrinsics lens.json\n"
            "  chorus import c3d walk.c3d --out rec   (also bvh, mvnx: their world becomes ours)\n"
            "Writes DIR/SENSOR.mcap, and registration.json and truth.ndjson where the source has "
            "them.\n"
            "Then: chorus fuse rec --out fused.ndjson, or chorus replay rec.",
            &add_import},
    Command{"replay", "Plays recordings as sensors: one chorus-sensor process for each",
            "Examples:\n"
            "  chorus replay rec --loop               all recordings of a folder, ports 8081, "
            "8082, ...\n"
            "  chorus replay rec/cam01.mcap --port 9001\n"
            "  chorus replay walk.mcap --speed 0.5    every sensor of one recording\n"
            "Ctrl-C stops all of them.",
            &add_replay},
    Command{"view", "Shows a recording in the cockpit: timeline, speed, the room in 3D",
            "Examples:\n"
            "  chorus view walk.mcap                  prints an address to open in a browser\n"
            "  chorus view walk.mcap --png t=12.4 --out walk.png    one picture (needs chromium)\n"
            "More: docs/guide/cockpit.md.",
            &add_view},
    Command{
        "fuse", "Fuses recordings of several sensors offline, registration included",
        "Examples:\n"
        "  chorus fuse rec --out fused.ndjson\n"
        "  chorus fuse walk.mcap --out fused.mcap --config other.json\n"
        "  chorus fuse rec --out fused.ndjson --registration rec/registration.json --method otto\n"
        "  chorus fuse rec --out - --config deploy/config/fusion.json | jq .bodies[0].joints.Head\n"
        "A recording, or one /frame document a line; the same input gives the same bytes.",
        &add_fuse},
    Command{"export", "Writes fused frames as BVH, C3D, TRC, CSV or glTF",
            "Examples:\n"
            "  chorus export cell.mcap --format c3d --out walk.c3d\n"
            "  chorus fuse rec --out - | chorus export - --format bvh --out walk.bvh\n"
            "  chorus export http://127.0.0.1:8080/ --seconds 20 --format gltf --out walk.glb\n"
            "  chorus export fused.ndjson --format csv --person 2 --out - | head\n"
            "What each format holds, and what is lost: docs/guide/export.md.",
            &add_export},
    Command{"train-error", "Learns how much a kind of sensor errs, from recordings with a truth",
            "Examples:\n"
            "  chorus train-error rec --truth rec/truth.ndjson --out kinect.json\n"
            "  chorus train-error walk.mcap --truth optical.ndjson --registration places.json "
            "--out kinect.json\n"
            "  chorus train-error rec --truth fused.ndjson --model boosting --out kinect.json\n"
            "Exit code 0: the model is written; 1: what is missing, and what to record, is "
            "printed.\n"
            "Then: fusion.errors, or \"errors\" of a sensor, in the fusion server's configuration.",
            &add_train_error},
    Command{
        "calibrate", "Measures the lens of a camera, and where it stands",
        "Examples:\n"
        "  chorus calibrate camera --print-board board.pdf\n"
        "  chorus calibrate camera /dev/video0 --out lens.json     move the board before it\n"
        "  chorus calibrate camera board.mp4 --square-mm 29.7 --out lens.json\n"
        "  chorus calibrate camera photos/ --board chessboard --squares 10x7 --out lens.json\n"
        "  chorus calibrate camera --fov 70 --size 1280x720 --out lens.json\n"
        "  chorus calibrate place /dev/video0 --intrinsics lens.json --out place.json    a board "
        "on the floor\n"
        "Exit code 0: the lens or the place is written; 1: the pictures are not enough, and what "
        "to do is "
        "printed.\n"
        "Then: device.camera.intrinsics, or chorus import video --intrinsics lens.json.",
        &add_calibrate},
    Command{"characterise", "Measures what a kind of sensor errs by: jitter, sides, view, depth",
            "Examples:\n"
            "  chorus characterise turn.mcap                           a person who turns once\n"
            "  chorus characterise turn.mcap --distance 2.50 --out kinect-v2\n"
            "  chorus characterise rec                                 a walk, several sensors\n"
            "Record somebody alone, 2 to 3 m before the sensor, who faces it for 5 s, turns once "
            "in 20 to 60 s,\n"
            "and turns back; or a mannequin.  What it says: docs/guide/research.md.",
            &add_characterise},
    Command{"align", "Compares our world with another tracker's, and makes them one",
            "Examples:\n"
            "  chorus align take.csv walk.mcap --body Cap              a marker on the head\n"
            "  chorus align take.csv --body Cap --marker-offset        walk now, for 60 s\n"
            "  chorus align vive.csv walk.mcap --joint HandRight --apply\n"
            "  chorus align optitrack.csv --seconds 0 --sensor-axes    bodies s1, s2 on the "
            "sensors\n"
            "Walk for half a minute, straight and in turns, while both trackers record.\n"
            "Exit code 0: they fit; 1: they do not, and why is printed.  More: "
            "docs/guide/align.md.",
            &add_align},
    Command{
        "scan", "Makes a hand's skeleton from a scan or photo of the open hand",
        "Examples:\n"
        "  chorus scan hand.png --out hand.bvh                     a scan whose file states its "
        "density\n"
        "  chorus scan hand.jpg --paper a4 --out hand.bvh          on a whole sheet of A4\n"
        "  chorus scan one.png two.png three.png --out hand.bvh    one hand: the median\n"
        "  chorus scan photos/ --card --out hands                  each picture on its own\n"
        "  chorus scan hand.png --method paper --json              Madaras et al., section 4\n"
        "Exit code 0: a hand is found; 1: none, and why is printed.  More: docs/guide/hands.md.",
        &add_scan},
    Command{"glove", "Puts a glove's take where a camera saw the hand",
            "Examples:\n"
            "  chorus glove video.mp4 take.bvh --hand hand.json --intrinsics lens.json --out "
            "placed.bvh\n"
            "  chorus glove video.mp4 take.bvh --hand hand.json --intrinsics lens.json --find "
            "network --out placed.bvh\n"
            "Exit code 0: placed; 1: the hand is in no picture.  More: docs/guide/hands.md.",
            &add_glove},
    Command{"report", "Says how good a recording is, and what to do about it",
            "Examples:\n"
            "  chorus report cell.mcap --out report.html --out report.json\n"
            "  chorus report fused.mcap rec              fused offline, with the sensors' own "
            "recordings\n"
            "  chorus report http://127.0.0.1:8080/ --seconds 60\n"
            "Exit code 0: usable, perhaps with care; 1: not usable as it is, and why is printed.  "
            "What each figure means: docs/guide/report.md.",
            &add_report},
    Command{"compare", "Compares two recordings of one motion, joint by joint",
            "Examples:\n"
            "  chorus compare fused.mcap again.mcap --same-clock --same-world    two fusions\n"
            "  chorus compare fused.mcap vicon.c3d --any-lag --other-world --out compare.html\n"
            "Exit code 0: no difference that chance does not explain; 1: different, or the two "
            "cannot be\n"
            "compared, and why is printed.  More: docs/guide/report.md.",
            &add_compare},
    Command{"score", "Scores postures by REBA, RULA, OWAS and others, and says how sure it is",
            "Examples:\n"
            "  chorus score fused.mcap                                 a summary\n"
            "  chorus score fused.mcap --method reba,owas --task task.json --out scores.csv\n"
            "  chorus score fused.mcap --task task.json --sheet sheet.html --language de\n"
            "  chorus score http://localhost:8090 --seconds 60 --sheet sheet.html\n"
            "A screening, not a certified assessment.  The task file: docs/guide/ergonomics.md.",
            &add_score},
    Command{
        "evaluate", "Judges a tracker with inertial sensors that the person wears",
        "Examples:\n"
        "  chorus evaluate --tracking walk.mcap --inertial suit.sto --out judged\n"
        "  chorus evaluate --tracking fused.ndjson --inertial MT_*.txt --limb 00B40C48=ShankLeft\n"
        "  chorus evaluate --tracking walk.mcap --inertial walk.mcap     both were recorded\n"
        "  chorus evaluate --tracking walk.mcap --inertial suit.mvnx --annotations a1.csv a2.csv\n"
        "  chorus evaluate --tracking walk.mcap --inertial suit.sto --reference vicon.c3d\n"
        "Writes OUT/evaluation.html, .json and .csv: Baak et al.'s distances, scores and figures.\n"
        "Exit code 0: no limb is in error for longer than --most; 1: one is, or why not judged.",
        &add_evaluate},
    Command{"position", "Puts the take of an inertial suit where cameras saw the person",
            "Examples:\n"
            "  chorus position cam01.mp4 walk.bvh --place place.json --intrinsics lens.json "
            "--out out\n"
            "  chorus position cam01.mcap cam02.mcap walk.mvnx --place places.json --stature 1.78 "
            "--out out\n"
            "Writes corrected.bvh, position.mcap and report.html.  More: docs/guide/suit.md.",
            &add_position},
    Command{"site", "Finds where the cells of a site stand to one another",
            "Examples:\n"
            "  chorus site register a=http://10.0.0.5:8080/ b=http://10.0.0.6:8080/ --out "
            "places.json\n"
            "  chorus site register a=a.mcap b=b.mcap        what both fused of one walk\n"
            "  chorus site register --mark a:1,2=b:-3,0.5 --mark a:1,4=b:-3,2.5\n"
            "Exit code 0: every cell has a place; 1: one has none, and why is printed.  More: "
            "docs/how/halls.md.",
            &add_site},
};

}  // namespace

std::span<const Command> recording_commands() { return kRecordingCommands; }

}  // namespace chorus::ctl
