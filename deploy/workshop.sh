#!/usr/bin/env bash
# Installs, checks and removes Chorus on the hosts of a workshop, over ssh.
#
#   deploy/workshop.sh INVENTORY lay-out    installs packages, time, configurations, services; if repeated, updates them
#   deploy/workshop.sh INVENTORY check      runs chorus doctor on every host
#   deploy/workshop.sh INVENTORY renew      makes new certificates on every host, used without a restart
#   deploy/workshop.sh INVENTORY remove     removes the packages; configuration and state stay
#   deploy/workshop.sh INVENTORY purge      removes everything
#
# INVENTORY is a JSON file, as in docs/guide/workshop.md.  You need ssh as root to each host without a password prompt.
# The fusion host is the certificate authority; its ca.crt is copied next to INVENTORY, for browsers and programs.
# CHORUS_SSH replaces `ssh`; like ssh it is called with the host and a command.
set -Eeuo pipefail

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
readonly told=64  # how a part of us in a subshell ends that has said why
fail() { printf '\nworkshop: %s\n' "$*" >&2; (( BASH_SUBSHELL == 0 )) || exit $told; exit 1; }

# What fails without words of our own ends here, with what we were about.
where='' doing=''
stopped() {
  local code=$?
  (( code != told && BASH_SUBSHELL == 0 )) || exit "$code"
  fail "stopped${where:+ at $where}${doing:+, $doing}; why stands above. Mend that and run this again: what is done stays"
}
trap stopped ERR

readonly there=/var/tmp/chorus-packages
read -ra ssh_command <<<"${CHORUS_SSH:-ssh -o BatchMode=yes -o ConnectTimeout=10}"

# on HOST COMMAND: runs the command on the host, with our standard input.
on() { "${ssh_command[@]}" "$1" "$2"; }

[[ $# == 2 ]] || { usage >&2; exit 2; }
inventory=$1 task=$2
[[ -f "$inventory" ]] || fail "there is no file $inventory: write one as in docs/guide/workshop.md (Write down the hosts)"
[[ -r "$inventory" ]] || fail "$inventory may not be read by $(id -un): chmod +r, or be its owner"
case $task in lay-out|check|renew|remove|purge) ;; *) usage >&2; fail "unknown task $task" ;; esac

# Lines "ROLE SSH ADDRESS ID DEVICE" with - for what is missing, sensors first; then "output OUTPUT" and "packages FOLDER".
read_inventory() {
  python3 - "$inventory" <<'PYTHON'
import json, re, sys
def wrong(why):
    sys.exit(f"\nworkshop: {sys.argv[1]}: {why}")
DEVICES = ("bridge", "camera", "phone", "simulated")
try:
    whole = json.load(open(sys.argv[1], encoding="utf-8"))
except ValueError as error:
    wrong(f"is no JSON: {error}")
WORD = re.compile(r"[A-Za-z0-9_.:@/\[\]-]+")
def word(value, what):
    if not isinstance(value, str) or not WORD.fullmatch(value) or value.startswith("-"):
        wrong(f"{what} is {value!r}; it needs letters, digits and _ . : @ / - only")
    return value
def known(entry, keys, where):
    if not isinstance(entry, dict):
        wrong(f"{where} is no object")
    for key in entry:
        if key not in keys:
            wrong(f"{where} has the unknown key {key!r}; it takes {', '.join(keys)}")
enters = {}
def host(entry, role, where):
    if "address" not in entry:
        wrong(f'{where} has no "address": that under which the other hosts reach it, such as 10.0.0.11')
    address = word(entry["address"], where + ".address")
    ssh = word(entry.get("ssh", "root@" + address), where + ".ssh")
    if (role, ssh) in enters:
        wrong(f"{where} is the same host as {enters[role, ssh]} ({ssh}); lay-out sets up one sensor a host, more are set up by hand")
    enters[role, ssh] = where
    print(role, ssh, address, entry.get("id", "none"), entry.get("device", "bridge"))
known(whole, ("packages", "fusion", "sensors"), "the file")
sensors = whole.get("sensors")
if not isinstance(sensors, list) or not sensors or "fusion" not in whole:
    wrong('needs "fusion" and a list "sensors", as in docs/guide/workshop.md')
for i, sensor in enumerate(sensors):
    where = f"sensors[{i}]"
    known(sensor, ("id", "address", "device", "ssh"), where)
    if not re.fullmatch(r"[A-Za-z0-9_-]{1,64}", str(sensor.get("id", ""))):
        wrong(f'{where} needs an "id" of 1 to 64 letters, digits, _ or -')
    if sensor.get("device", "bridge") not in DEVICES:
        wrong(f"{where}.device is {sensor['device']!r}; it is one of {', '.join(DEVICES)}")
ids = [sensor["id"] for sensor in sensors]
if len(set(ids)) != len(ids):
    wrong('every sensor needs an "id" of its own')
for i, sensor in enumerate(sensors):
    host(sensor, "sensor", f"sensors[{i}]")
known(whole["fusion"], ("address", "outputs", "ssh"), "fusion")
host(whole["fusion"], "fusion", "fusion")
outputs = whole["fusion"].get("outputs", [])
if not isinstance(outputs, list):
    wrong('fusion.outputs is no list, such as ["vrpn=10.0.0.20"]')
for output in outputs:
    if not isinstance(output, str) or not re.fullmatch(r"[a-z]+(=[0-9A-Fa-f.:,/]+)?", output):
        wrong(f"the output {output!r} is not of the form vrpn=10.0.0.20 or dtrack=10.0.0.20:5000")
    print("output", output)
print("packages", word(whole.get("packages", "var/packages"), "packages"))
PYTHON
}

hosts=() outputs=() packages=''
lines=$(read_inventory) || exit 1
while read -r role rest; do
  case $role in
    sensor|fusion) hosts+=("$role $rest") ;;
    output) outputs+=("$rest") ;;
    packages) packages=$rest ;;
  esac
done <<<"$lines"
read -r fusion_host fusion_address < <(printf '%s\n' "${hosts[@]}" | awk '$1 == "fusion" {print $2, $3}')

# Ends unless we enter the host as root.
reach() {  # SSH
  local as
  as=$(on "$1" "id -u" </dev/null) ||
    fail "$1 does not let us in; why stands above. Is it on, with that address? Then try ssh $1 true, and copy your key there (ssh-copy-id $1)"
  [[ $as == 0 ]] || fail "$1 does not let us in as root: name another user in \"ssh\", such as root@..."
}

reach_all() {
  local role host rest
  for entry in "${hosts[@]}"; do
    read -r role host rest <<<"$entry"
    reach "$host"
  done
}

# Prints the folder of packages for a host: that of the inventory, or the one beside it for the host's architecture.
packages_for() {  # SSH
  local arch made_for folder
  arch=$(on "$1" "dpkg --print-architecture" </dev/null)
  made_for=$(cat "$packages/SYSTEM")
  folder=$packages
  [[ $made_for == *-"$arch" ]] || folder+=-$arch
  [[ -x "$folder/install.sh" ]] || fail "$1 is $arch, and there are no packages in $folder: deploy/make-packages.sh --arch $arch makes them"
  echo "$folder"
}

install_on() {  # SSH PACKAGE...
  local host=$1 folder lacking; shift
  folder=$(packages_for "$host")
  doing="installing $*"
  tar -C "$folder" -cf - SYSTEM Packages install.sh | on "$host" "rm -rf $there && mkdir -p $there && tar -C $there -xf -"
  lacking=$(on "$host" "$there/install.sh --list $*" </dev/null)
  [[ -z $lacking ]] || tar -C "$folder" -cf - --files-from=<(echo "$lacking") | on "$host" "tar -C $there -xf -"
  on "$host" "$there/install.sh $*" </dev/null
}

# Sensor hosts follow the fusion host's time; a fusion host without a time server serves its own clock.
keep_time() {  # ROLE SSH
  doing="setting up chrony"
  if [[ $1 == fusion ]]; then
    { echo "# Chorus: the time of the workshop"; echo "local stratum 10"
      printf '%s\n' "${hosts[@]}" | awk '$1 == "sensor" {print "allow " $3}'
    } | on "$2" "cat > /etc/chrony/conf.d/chorus.conf && systemctl restart chrony"
  else
    printf '# Chorus: follow the fusion host\nserver %s iburst\nmakestep 0.1 3\n' "$fusion_address" |
      on "$2" "cat > /etc/chrony/conf.d/chorus.conf && systemctl restart chrony"
  fi
}

# Reads a sensor's configuration on standard input; prints how to poll it: "https://10.0.0.11:8081/,TOKEN".
way_to() {  # ADDRESS
  python3 -c '
import json, re, sys
text = re.sub(r"(\"(?:\\.|[^\"\\])*\")|//[^\n]*", lambda match: match.group(1) or "", sys.stdin.read())
http = json.loads(text).get("http", {})
token = next((t["token"] for t in http.get("tokens", []) if t.get("role") == "read"), "")
host = f"[{sys.argv[1]}]" if ":" in sys.argv[1] else sys.argv[1]
scheme = "https" if http.get("tls") else "http"
port = http.get("port", 8081)
print(f"{scheme}://{host}:{port}/" + ("," + token if token else ""))' "$1"
}

# What chorus init says contains tokens, so it is shown only where it fails.
init() { echo "{ said=\$(chorus init $* 2>&1 >/dev/null) || { echo \"\$said\" >&2; exit 1; }; }"; }

# The authority is made once, on the fusion host, and its key stays there.
found_authority() {
  doing="making the authority"
  on "$fusion_host" "test -e /etc/chorus/ca/ca.crt || $(init ca)" </dev/null
  on "$fusion_host" "cat /etc/chorus/ca/ca.crt" </dev/null > "$(dirname "$inventory")/ca.crt"
}

# Makes a certificate for a host's name and address.  Its key passes through our pipe, never through a file of ours.
certify() {  # SSH ADDRESS [--renew]
  local name
  doing="making its certificate on $fusion_host"
  if [[ -z "${3:-}" ]] && on "$1" "test -e /etc/chorus/tls/host.crt" </dev/null; then return; fi
  name=$(on "$1" hostname </dev/null)
  [[ $name =~ ^[A-Za-z0-9_.-]+$ ]] || name=$2
  on "$fusion_host" "t=\$(mktemp -d) && trap 'rm -rf \$t' EXIT && $(init certificate "$name $name.local $2 --out \$t/tls") && tar -C \$t -cf - tls" </dev/null |
    on "$1" "tar -C /etc/chorus --no-same-owner -xf - && chown -R root:chorus /etc/chorus/tls && chmod 751 /etc/chorus/tls"
}

lay_out_sensor() {  # SSH ADDRESS ID DEVICE
  local packages_of_device=chorus-sensor
  [[ $4 != camera && $4 != phone ]] || packages_of_device=chorus-camera
  install_on "$1" $packages_of_device chrony
  [[ $1 == "$fusion_host" ]] || keep_time sensor "$1"
  certify "$1" "$2"
  doing="writing and starting the sensor"
  on "$1" "test -e /etc/chorus/sensor.json || $(init sensor --id "$3" --device "$4")" </dev/null
  on "$1" "systemctl restart chorus-sensor" </dev/null
  polled+=("$3=$(on "$1" "cat /etc/chorus/sensor.json" </dev/null | way_to "$2")")
}

# What the sensor hosts need from the fusion host comes first: the time and the certificates.
lay_out_authority() {  # SSH ADDRESS
  install_on "$1" chorus-fusion chrony
  keep_time fusion "$1"
  found_authority
  certify "$1" "$2"
}

lay_out_fusion() {  # SSH
  local wishes=''
  (( ${#outputs[@]} == 0 )) || wishes=$(printf ' --output %s' "${outputs[@]}")
  # Tokens pass through standard input, because every user of that host can see a command line.
  doing="writing and starting the fusion server"
  printf '%s\n' "${polled[@]}" |
    on "$1" "if test -e /etc/chorus/fusion.json; then cat >/dev/null; else $(init fusion --sensors-from -"$wishes"); fi"
  on "$1" "systemctl restart chorus-fusion" </dev/null
  name_unread_sensors "$1"
}

# A fusion.json that was there is kept, so it may lack sensors that came later.
name_unread_sensors() {  # SSH
  local kept sensor way id
  kept=$(on "$1" "cat /etc/chorus/fusion.json" </dev/null)
  for sensor in "${polled[@]}"; do
    id=${sensor%%=*} way=${sensor#*=}
    [[ $kept != *"\"$id\""* ]] || continue
    step "sensor $id is not in /etc/chorus/fusion.json of $1, which was there before: add it to \"sensors\", then systemctl reload chorus-fusion"
    printf '{ "id": "%s", "url": "%s", "token": "%s" }\n' "$id" "${way%%,*}" "${way#*,}"
  done
}

lay_out() {
  [[ -x "$packages/install.sh" && -f "$packages/SYSTEM" ]] || fail "there are no packages in $packages: deploy/make-packages.sh makes them"
  polled=()
  local role host address id device
  reach_all
  for entry in "${hosts[@]}"; do
    read -r role host address id device <<<"$entry"
    where=$host
    packages_for "$host" >/dev/null
  done
  where=$fusion_host
  step "authority $fusion_host"
  lay_out_authority "$fusion_host" "$fusion_address"
  for entry in "${hosts[@]}"; do
    read -r role host address id device <<<"$entry"
    where=$host
    step "$role $host"
    if [[ $role == sensor ]]; then lay_out_sensor "$host" "$address" "$id" "$device"; else lay_out_fusion "$host"; fi
  done
  step "laid out; next: $0 $inventory check, then walk through the room (chorus register on the fusion host)"
}

renew() {
  local role host address rest
  reach_all
  where=$fusion_host
  found_authority
  for entry in "${hosts[@]}"; do
    read -r role host address rest <<<"$entry"
    where=$host
    step "$role $host"
    certify "$host" "$address" --renew
    doing="reloading chorus-$role"
    on "$host" "systemctl reload chorus-$role" </dev/null
  done
  step "new certificates on ${#hosts[@]} hosts"
}

# for_each COMMAND: runs it on every host, the others too if it fails on one; sets bad to the number of these.
for_each() {
  local role host rest code
  bad=0
  for entry in "${hosts[@]}"; do
    read -r role host rest <<<"$entry"
    step "$role $host"
    code=0
    on "$host" "$1" </dev/null || code=$?
    (( code == 0 )) || bad=$(( bad + 1 ))
    case $code in
      127) printf 'WRONG  Chorus is not installed on %s\n       -> %s lay-out\n' "$host" "$0 $inventory" ;;
      255) printf 'WRONG  %s cannot be reached by ssh\n       -> is it on, with that address? try ssh %s true\n' "$host" "$host" ;;
    esac
  done
}

check() {
  for_each "chorus doctor"
  (( bad == 0 )) || fail "$bad of ${#hosts[@]} hosts are not well; what to do stands above"
  step "all ${#hosts[@]} hosts are well"
}

take_away() {  # remove|purge
  for_each "DEBIAN_FRONTEND=noninteractive apt-get -q -y $1 'chorus-*' && rm -rf $there /etc/chrony/conf.d/chorus.conf"
  (( bad == 0 )) || fail "$bad of ${#hosts[@]} hosts still have something; mend what stands above and run this again"
  step "done on ${#hosts[@]} hosts"
}

case $task in
  lay-out) lay_out ;;
  check) check ;;
  renew) renew ;;
  remove|purge) take_away "$task" ;;
esac
