#!/usr/bin/env bash
# Starts six simulated sensors, one fusion server and a walking person.  Ctrl-C stops everything it started.
#
#   deploy/demo.sh                  runs until Ctrl-C
#   deploy/demo.sh --seconds 60     stops by itself; exit code 0 only if the fused tracker delivered
#   deploy/demo.sh --recording [DIR]  plays recordings instead of simulating: the *.mcap files of DIR, with the
#                                   extrinsics of DIR/registration.json if that exists, else the recorded ones,
#                                   and the settings of DIR/fusion.json if that exists; a folder of camera
#                                   landmarks is imported first; without DIR, it plays the four real cameras
#                                   that ship with the tests
#   --cameras                       uses the videos of four cameras that ship with the tests: each has a sensor
#                                   whose runner finds the person in its pictures, and the fusion server makes
#                                   bodies of their rays, with the published extrinsics
#   --suit                          puts the take of an inertial suit where a camera saw its wearer (chorus position, on the video
#                                   and the take that ship with the tests), and fuses the result like any sensor's
#   --inertial                      the person exercises and wears thirteen simulated trackers, one of which slips after 20 s:
#                                   chorus-evaluation judges the fused tracker by them (port 21 after the fusion server's), `chorus
#                                   status` and the viewer say which limb is off, and `chorus evaluate` writes a report of the take
#   --site                          two cells of three simulated sensors each, the NATS server by which they meet, and somebody who
#                                   walks from one into the other and back: /site/people/ shows one id (docs/guide/hall.md)
#   --until-good                    with --seconds: stops earlier, as soon as the places are good and it delivers
#   --register                      with --recording: finds the extrinsics from the person alone
#   --port N                        the fusion server's port (8080); the sensors use the ports after it, live posture scores
#                                   the port 20 after it
#   --sheet FILE                    with --seconds: writes filled assessment sheets of the last half of the run
#   --set PATH=VALUE                is passed to chorus-fusion; may be repeated
#   --bin DIR                       uses the programs in DIR; installs and builds nothing
#
# Installs what is missing and builds the release preset.  Logs are in var/demo/PORT/.
set -euo pipefail
readonly called_from=$PWD
cd "$(dirname "$0")/.."

readonly sensor_count=6
readonly start_within_s=60  # a loaded machine; a program that ends is noticed at once
readonly bundled_recording=tests/data/pose2sim_mediapipe
readonly bundled_cameras=tests/data/pose2sim_videos/four
readonly camera_count=4
readonly bundled_suit=tests/data/suit

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\ndemo: %s\n' "$*" >&2; exit 1; }

sheet='' seconds='' until_good='' recording='' cameras='' suit='' inertial='' site='' register='' port=8080 overrides=() bin=build/release/bin build=yes
read_arguments() {
  while (( $# > 0 )); do
    case $1 in
      --seconds) seconds=${2:?--seconds needs a number}; shift ;;
      --recording)
        recording=$bundled_recording
        if [[ -n "${2:-}" && "${2:0:2}" != -- ]]; then recording=$2; shift; fi ;;
      --cameras) cameras=yes ;;
      --suit) suit=yes ;;
      --inertial) inertial=yes ;;
      --site) site=yes ;;
      --sheet) sheet=${2:?--sheet needs a file}; shift ;;
      --register) register=yes ;;
      --until-good) until_good=yes ;;
      --port) port=${2:?--port needs a number}; shift ;;
      --set) overrides+=(--set "${2:?--set needs PATH=VALUE}"); shift ;;
      --bin) bin=${2:?--bin needs a folder}; build=''; shift ;;
      -h|--help) usage; exit 0 ;;
      *) usage >&2; fail "unknown option $1" ;;
    esac
    shift
  done
  [[ -z "$seconds" || "$seconds" =~ ^[0-9]+$ ]] || fail "--seconds needs a whole number, not '$seconds'"
  [[ "$port" =~ ^[0-9]+$ ]] || fail "--port needs a number, not '$port'"
  # A folder is named from where the script was called; the ones that ship with it are named from the repository.
  [[ -z "$recording" || "$recording" = /* || ! -e "$called_from/$recording" ]] || recording=$called_from/$recording
  [[ ! -f "$recording" ]] || fail "'$recording' is a file: name the folder it is in"
  [[ -z "$recording" || -d "$recording" ]] || fail "there is no folder '$recording'"
  [[ -z "$recording" || -z "$cameras" ]] || fail "--cameras and --recording are two demos: choose one"
  [[ -z "$suit" || -z "$recording$cameras" ]] || fail "--suit is a demo of its own: leave out --cameras and --recording"
  [[ -z "$inertial" || -z "$recording$cameras$suit" ]] || fail "--inertial simulates its sensors: leave out --recording, --cameras and --suit"
  [[ -z "$site" || -z "$recording$cameras$suit$inertial$sheet$until_good" ]] || fail "--site is a demo of its own: it goes with --port and --seconds"
  [[ -n "$recording" || -z "$register" ]] || fail "--register goes with --recording"
  [[ -z "$sheet" || -n "$seconds" ]] || fail "--sheet goes with --seconds"
  [[ -z "$sheet" || "$sheet" = /* ]] || sheet=$called_from/$sheet
}

# --- what we started, and stopping it -------------------------------------------------------------

children=() sensor_processes=0 scores_pid='' sheet_pid='' judge_pid=''
# start NAME COMMAND...: runs it in the background, with its log in NAME.log. The process ends with this script.
start() {
  local name=$1; shift
  : > "$logs/$name.out"  # the file exists before the process, for those who read it
  setpriv --pdeathsig TERM "$@" > "$logs/$name.out" 2> "$logs/$name.log" &
  children+=($!)
}

# All background jobs are asked for, because a signal can arrive after one was started and before its number was noted.
stop_all() {
  trap - EXIT
  trap '' INT TERM
  local i child
  # The fusion server was started last and stops first, so that it need not see its sensors vanish.
  for (( i = ${#children[@]} - 1; i >= sensor_processes; --i )); do kill -TERM "${children[i]}" 2>/dev/null || true; done
  (( ${#children[@]} <= sensor_processes )) || sleep 0.2
  for child in $(jobs -p); do kill -TERM "$child" 2>/dev/null || true; done
  for (( i = 0; i < 50; ++i )); do
    [[ -n "$(jobs -rp)" ]] || break
    sleep 0.1
  done
  for child in $(jobs -rp); do kill -KILL "$child" 2>/dev/null || true; done
  wait 2>/dev/null || true
}

all_alive() {
  local child
  for child in "${children[@]}"; do kill -0 "$child" 2>/dev/null || return 1; done
}

show_logs() {
  local log
  for log in "$logs"/*.log; do
    [[ -s "$log" ]] && printf -- '--- %s\n' "$log" >&2 && tail -n 5 "$log" >&2
  done
}

# --- preparation ----------------------------------------------------------------------------------

build() {
  step "packages"
  deploy/install-packages.sh build
  install_modules services/viewer
  [[ -z "$cameras$suit" ]] || install_modules services/pose-runner
  step "build"
  local launcher=()
  export CCACHE_SLOPPINESS=pch_defines,time_macros
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake --preset release "${launcher[@]}" --log-level=WARNING > "$logs/configure.out"
  cmake --build build/release -j "$(deploy/build-jobs.sh)" --target chorus-sensor chorus-fusion chorus chorus-ergonomics \
    chorus-evaluation
}

# install_modules FOLDER: installs what its package-lock.json names, unless that is already there.
install_modules() {
  cmp -s "$1/package-lock.json" "$1/node_modules/.chorus-lock" && return
  npm ci --prefix "$1" --no-progress
  cp "$1/package-lock.json" "$1/node_modules/.chorus-lock"
}

need_free_ports() {
  local p
  for (( p = port; p <= port + $1; ++p )); do
    if (exec 3<> "/dev/tcp/127.0.0.1/$p") 2>/dev/null; then
      fail "port $p is in use: stop what listens there (ss -ltnp), or choose others with --port N"
    fi
  done
}

# wait_for URL WHAT: waits until URL answers, whatever the answer is.
wait_for() {
  local deadline=$(( SECONDS + start_within_s ))
  until curl -s -o /dev/null --max-time 2 "$1"; do
    all_alive || { show_logs; fail "$2 ended; its log is above and in $logs/"; }
    (( SECONDS < deadline )) || { show_logs; fail "$2 did not answer within $start_within_s s"; }
    sleep 0.1
  done
}

# --- sensors --------------------------------------------------------------------------------------

sensors=()  # as JSON objects, for the fusion server
add_sensor() { sensors+=("{\"id\":\"$1\",\"url\":\"$2\"}"); }

# Calibrating worn sensors takes more than walking.
scene_options() { [[ -z "$inertial" ]] || printf '%s\n' --set "$1.exercise=true"; }

start_simulated() {
  local i more
  mapfile -t more < <(scene_options device.simulated.scene)
  for (( i = 0; i < sensor_count; ++i )); do
    local id="s$(( i + 1 ))" p=$(( port + 1 + i ))
    start "$id" "$bin/chorus-sensor" --config deploy/config/sensor.json --set "id=$id" --set "http.port=$p" \
      --set device.kind=simulated --set "device.simulated.ring.index=$i" --set "device.simulated.ring.count=$sensor_count" \
      "${more[@]}"
    add_sensor "$id" "http://127.0.0.1:$p/"
  done
}

start_replays() {
  if [[ -f "$recording/cameras.json" ]]; then
    step "import of $recording"
    rm -rf "$logs/recording"
    "$bin/chorus" import pose2sim "$recording" --out "$logs/recording"
    [[ ! -f "$recording/fusion.json" ]] || cp "$recording/fusion.json" "$logs/recording/"
    recording=$logs/recording
  fi
  local files=("$recording"/*.mcap)
  [[ -f "${files[0]}" ]] || fail "there is no *.mcap in $recording (chorus import makes them)"
  start replay "$bin/chorus" replay "$recording" --port $(( port + 1 )) --loop \
    --save-registration "$logs/registration.json"
  local deadline=$(( SECONDS + start_within_s ))
  until grep -q '^playing ' "$logs/replay.out"; do
    all_alive || { show_logs; fail "the replay ended"; }
    (( SECONDS < deadline )) || { show_logs; fail "the replay did not start within $start_within_s s"; }
    sleep 0.1
  done
  while read -r id _ url _; do add_sensor "$id" "$url"; done < <(grep ' at http' "$logs/replay.out")
}

# Without the runner's modules the outline alone tells where the person is.
place_suit() {
  local method=both
  [[ -d services/pose-runner/node_modules ]] || method=outline
  step "the suit's place, by $method"
  rm -rf "$logs/suit" && mkdir -p "$logs/suit/play"
  "$bin/chorus" position $bundled_suit/cam01.mp4 $bundled_suit/walk.bvh --place $bundled_suit/place.json \
    --intrinsics $bundled_suit/lens.json --method $method --out "$logs/suit" || fail "the suit could not be placed"
  mv "$logs/suit/position.mcap" "$logs/suit/play/"
  # Its space is the world already.
  echo '{"version":1,"master":"positioner","sensors":{"positioner":{"x":0,"y":0,"z":0,"qx":0,"qy":0,"qz":0,"qw":1}}}' \
    > "$logs/suit/play/registration.json"
  recording=$logs/suit/play
}

start_cameras() {
  local i
  for (( i = 1; i <= camera_count; ++i )); do
    local p=$(( port + i ))
    start "cam0$i" "$bin/chorus-sensor" --config "$bundled_cameras/cam0$i.json" --set "http.port=$p"
    add_sensor "cam0$i" "http://127.0.0.1:$p/"
  done
}

start_fusion() {
  local config=deploy/config/fusion.json list
  list=$(IFS=,; echo "[${sensors[*]}]")
  local options=(--set "http.port=$port" --set "sensors=$list" --set "recording.folder=$logs/recordings" --set "state_dir=$logs/state")
  if [[ -n "$recording" ]]; then
    [[ ! -f "$recording/fusion.json" ]] || config=$recording/fusion.json
    local places=$recording/registration.json
    [[ -f "$places" ]] || places=$logs/registration.json  # the recorded ones
    if [[ -z "$register" && -f "$places" ]]; then
      options+=(--set "registration.file=$places" --set registration.auto=false)
    fi
  fi
  if [[ -n "$cameras" ]]; then
    options+=(--set "registration.file=$bundled_cameras/registration.json" --set registration.auto=false)
  fi
  if [[ -n "$inertial" ]]; then
    options+=(--set "inertial=[{\"id\":\"suit\",\"url\":\"http://127.0.0.1:$suit_port/\"}]"
      --set "evaluation.url=http://127.0.0.1:$evaluation_port/")
  fi
  start fusion "$bin/chorus-fusion" --config "$config" "${options[@]}" "${overrides[@]}"
}

# Live posture scores, and the sheet.  The tracker does without them, so nobody waits for them.
start_scores() {
  local p=$(( port + 20 ))
  if [[ -x $bin/chorus-ergonomics ]] && ! (exec 3<> "/dev/tcp/127.0.0.1/$p") 2>/dev/null; then
    setpriv --pdeathsig TERM "$bin/chorus-ergonomics" --tracker "$base/" --set "http.port=$p" > "$logs/ergonomics.out" 2> "$logs/ergonomics.log" &
    scores_pid=$!
  fi
  [[ -n "$sheet" ]] || return 0
  (sleep $(( seconds / 2 )); exec "$bin/chorus" score "$base/" --seconds $(( seconds / 2 > 3 ? seconds / 2 - 2 : 1 )) --sheet "$sheet" --out "$logs/scores.json") \
    > "$logs/score.out" 2> "$logs/score.log" &
  sheet_pid=$!
}

# Ends what start_scores began; the sheet first.
finish_scores() {
  if [[ -n "$sheet_pid" ]]; then
    if wait "$sheet_pid"; then echo "posture sheets: $sheet"; else echo "no posture sheets: $(tail -n 1 "$logs/score.log")"; fi
    sheet_pid=''
  fi
  [[ -z "$scores_pid" ]] || kill -TERM "$scores_pid" 2>/dev/null || true
}

# --- a tracker judged by worn sensors -------------------------------------------------------------

readonly judged_s=45 slip_after_s=20
# Waits until the sensors are placed; then a suit, its judge, a recording and a report of it.  What it starts ends with it.
judge_tracker() {
  until curl -s --max-time 2 -H 'Accept: application/json' "$base/registration" | grep -q '"verdict": *"Good"'; do sleep 0.5; done
  local more suit
  mapfile -t more < <(scene_options device.inertial.scene)
  suit='[{"id":"suit","url":"http://127.0.0.1:'$suit_port'/"}]'
  setpriv --pdeathsig TERM "$bin/chorus-sensor" --id suit --port "$suit_port" --device inertial --set device.inertial.source=simulated \
    --set device.inertial.slips=ForearmLeft --set device.inertial.slips_across=true --set "device.inertial.slips_after_s=$slip_after_s" \
    --set device.inertial.slips_by_deg=70 "${more[@]}" > "$logs/suit.out" 2> "$logs/suit.log" &
  setpriv --pdeathsig TERM "$bin/chorus-evaluation" --tracker "$base/" --port "$evaluation_port" --set "inertial=$suit" \
    > "$logs/evaluation.out" 2> "$logs/evaluation.log" &
  sleep 1
  rm -f "$logs/judged.mcap"
  setpriv --pdeathsig TERM "$bin/chorus" record "$base/" --out "$logs/judged.mcap" --seconds "$judged_s" > "$logs/record.out" 2> "$logs/record.log" &
  local recorder=$! said=''
  while kill -0 "$recorder" 2>/dev/null; do
    sleep 1
    [[ -z "$said" ]] || continue
    # A limb that has been off for more than 10 s: passing doubts are no news.
    said=$("$bin/chorus" status --url "$base/" 2>/dev/null | grep -E ' off by .* for [1-9][0-9]+ s' | head -n 1 || true)
    [[ -z "$said" ]] || printf 'chorus status: %s\n' "$said"
  done
  wait "$recorder" || { tail -n 3 "$logs/record.log"; return 1; }
  "$bin/chorus" evaluate --tracking "$logs/judged.mcap" --inertial "$logs/judged.mcap" --same-clock --most 100 --out "$logs/judged" \
    2> "$logs/evaluate.log" || { tail -n 3 "$logs/evaluate.log"; return 1; }
  echo "report: $logs/judged/evaluation.html"
}

start_judging() {
  [[ -n "$inertial" ]] || return 0
  judge_tracker &
  judge_pid=$!
}

finish_judging() {
  [[ -n "$judge_pid" ]] || return 0
  wait "$judge_pid" || { judge_pid=''; fail "the tracker was not judged; logs in $logs/"; }
  judge_pid=''
}

# --- main -----------------------------------------------------------------------------------------

read_arguments "$@"
logs=var/demo/$port suit_port=$(( port + sensor_count + 1 )) evaluation_port=$(( port + 21 ))
mkdir -p "$logs"
rm -f "$logs"/*.log "$logs"/*.out "$logs"/registration.json
rm -rf "$logs/state"  # each demo registers its sensors anew
# How many sensors a recording has is only known when it is played; each of them complains if its port is taken.
if [[ -n "$recording$suit" ]]; then need_free_ports 1; elif [[ -n "$site" ]]; then need_free_ports 8; else need_free_ports $(( sensor_count + 1 )); fi
[[ -z "$build" ]] || build
if [[ -n "$site" ]]; then
  command -v nats-server >/dev/null || PATH+=:/usr/sbin
  command -v nats-server >/dev/null || { step "nats-server"; deploy/install-packages.sh site; }
  rm -rf "$logs/site" && mkdir -p "$logs/site"
  exec python3 -B deploy/demo_site.py --bin "$bin" --port "$port" --folder "$logs/site" ${seconds:+--seconds "$seconds"}
fi

trap stop_all EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
step "start"
[[ -z "$suit" ]] || place_suit
if [[ -n "$recording" ]]; then start_replays; elif [[ -n "$cameras" ]]; then start_cameras; else start_simulated; fi
sensor_processes=${#children[@]}
for sensor in "${sensors[@]}"; do
  url=${sensor##*\"url\":\"}; url=${url%%\"*}
  wait_for "${url}healthz" "the sensor at $url"
done
start_fusion
fusion_pid=${children[-1]}
wait_for "http://127.0.0.1:$port/healthz" "the fusion server"

base=http://127.0.0.1:$port
cat <<TEXT
${#sensors[@]} sensors at $(( port + 1 ))..$(( port + ${#sensors[@]} )), fusion server at $port

  viewer:  $base/viewer/
  try:     curl -s $base/frame
           curl -s -H 'Accept: application/json' $base/frame
           curl -s -H 'Accept: application/json' $base/registration
  scores:  curl -s -H 'Accept: application/json' http://127.0.0.1:$(( port + 20 ))/ergonomics/

TEXT
[[ -z "$inertial" ]] || printf '  judged:  %s\n\n' "curl -s -H 'Accept: application/json' http://127.0.0.1:$evaluation_port/evaluation"
start_scores
start_judging
[[ -n "$seconds" ]] || echo "Ctrl-C stops everything."

watcher=(python3 -B deploy/watch_tracker.py --base "$base")
[[ -z "$seconds" ]] || watcher+=(--seconds "$seconds")
[[ -z "$until_good" ]] || watcher+=(--until-good)
setpriv --pdeathsig TERM "${watcher[@]}" &
watch_pid=$!
children+=("$watch_pid")
# The demo ends when the watcher gives its verdict or the fusion server ends.  A sensor that ends is only reported: the tracker
# lives on without it, as it would in a workshop.
while true; do
  alive=()
  for child in "${children[@]}"; do
    if kill -0 "$child" 2>/dev/null; then
      alive+=("$child")
    elif [[ "$child" != "$fusion_pid" ]]; then
      echo "a sensor ended; the tracker goes on without it (see $base/sensors/)"
    fi
  done
  children=("${alive[@]}")
  # Asked before each wait: when it ends together with a sensor, only the sensor is waited for.
  if ! kill -0 "$fusion_pid" 2>/dev/null; then
    verdict=0; wait "$fusion_pid" || verdict=$?
    show_logs
    fail "the fusion server ended by itself with code $verdict; logs in $logs/"
  fi
  verdict=0 ended=''
  wait -n -p ended "${children[@]}" || verdict=$?
  if [[ "$ended" == "$watch_pid" ]]; then finish_scores; finish_judging; exit "$verdict"; fi
done
