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
set -euo pipefail

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\nworkshop: %s\n' "$*" >&2; exit 1; }

readonly there=/var/tmp/chorus-packages
read -ra ssh_command <<<"${CHORUS_SSH:-ssh -o BatchMode=yes -o ConnectTimeout=10}"

# on HOST COMMAND: runs the command on the host, with our standard input.
on() { "${ssh_command[@]}" "$1" "$2"; }

[[ $# == 2 ]] || { usage >&2; exit 2; }
inventory=$1 task=$2
[[ -f "$inventory" ]] || fail "there is no file $inventory"

# Lines "ROLE SSH ADDRESS ID DEVICE" with - for what is missing, sensors first; then "output OUTPUT" and "packages FOLDER".
read_inventory() {
  python3 - "$inventory" <<'PYTHON'
import json, re, sys
def wrong(why):
    sys.exit(f"workshop: {sys.argv[1]}: {why}")
try:
    whole = json.load(open(sys.argv[1], encoding="utf-8"))
except ValueError as error:
    wrong(f"is no JSON: {error}")
WORD = re.compile(r"[A-Za-z0-9_.:@/\[\]-]+")
def word(value, what):
    if not isinstance(value, str) or not WORD.fullmatch(value) or value.startswith("-"):
        wrong(f"{what} is {value!r}; it needs letters, digits and _ . : @ / - only")
    return value
def host(entry, role, where):
    if not isinstance(entry, dict):
        wrong(f"{where} is no object")
    unknown = set(entry) - {"ssh", "address", "id", "device", "outputs"}
    if unknown:
        wrong(f"{where} has the unknown key {sorted(unknown)[0]!r}")
    address = word(entry.get("address"), where + ".address")
    print(role, word(entry.get("ssh", "root@" + address), where + ".ssh"), address, word(entry.get("id", "none"), where + ".id"),
          word(entry.get("device", "bridge"), where + ".device"))
sensors = whole.get("sensors") if isinstance(whole, dict) else None
if not isinstance(sensors, list) or not sensors or "fusion" not in whole:
    wrong('needs "fusion" and a list "sensors"')
ids = [sensor.get("id") if isinstance(sensor, dict) else None for sensor in sensors]
if None in ids or len(set(ids)) != len(ids):
    wrong('every sensor needs an "id" of its own')
for i, sensor in enumerate(sensors):
    host(sensor, "sensor", f"sensors[{i}]")
host(whole["fusion"], "fusion", "fusion")
for output in whole["fusion"].get("outputs", []):
    if not isinstance(output, str) or not re.fullmatch(r"[a-z]+(=[0-9A-Fa-f.:,/]+)?", output):
        wrong(f"the output {output!r} is not of the form vrpn=10.0.0.20 or dtrack=10.0.0.20:5000")
    print("output", output)
print("packages", word(whole.get("packages", "var/packages"), "packages"))
PYTHON
}

hosts=() outputs=() packages=''
lines=$(read_inventory)
while read -r role rest; do
  case $role in
    sensor|fusion) hosts+=("$role $rest") ;;
    output) outputs+=("$rest") ;;
    packages) packages=$rest ;;
  esac
done <<<"$lines"
read -r fusion_host fusion_address < <(printf '%s\n' "${hosts[@]}" | awk '$1 == "fusion" {print $2, $3}')

reach() { on "$1" true </dev/null || fail "$1 does not let us in: try ssh $1 true, and copy your key there (ssh-copy-id)"; }

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
  local host=$1 folder; shift
  folder=$(packages_for "$host")
  tar -C "$folder" -cf - --exclude=./debug . | on "$host" "rm -rf $there && mkdir -p $there && tar -C $there -xf -"
  on "$host" "$there/install.sh $*" </dev/null
}

# Sensor hosts follow the fusion host's time; a fusion host without a time server serves its own clock.
keep_time() {  # ROLE SSH
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

# The authority is made once, on the fusion host, and its key stays there.
found_authority() {
  on "$fusion_host" "test -e /etc/chorus/ca/ca.crt || chorus init ca 2>/dev/null" </dev/null
  on "$fusion_host" "cat /etc/chorus/ca/ca.crt" </dev/null > "$(dirname "$inventory")/ca.crt"
}

# Makes a certificate for a host's name and address.  Its key passes through our pipe, never through a file of ours.
certify() {  # SSH ADDRESS [--renew]
  local name
  if [[ -z "${3:-}" ]] && on "$1" "test -e /etc/chorus/tls/host.crt" </dev/null; then return; fi
  name=$(on "$1" hostname </dev/null)
  [[ $name =~ ^[A-Za-z0-9_.-]+$ ]] || name=$2
  on "$fusion_host" "t=\$(mktemp -d) && chorus init certificate $name $name.local $2 --out \$t/tls 2>/dev/null && tar -C \$t -cf - tls; rm -rf \$t" </dev/null |
    on "$1" "tar -C /etc/chorus --no-same-owner -xf - && chown -R root:chorus /etc/chorus/tls && chmod 751 /etc/chorus/tls"
}

lay_out_sensor() {  # SSH ADDRESS ID DEVICE
  install_on "$1" chorus-sensor chrony
  keep_time sensor "$1"
  certify "$1" "$2"
  on "$1" "test -e /etc/chorus/sensor.json || chorus init sensor --id $3 --device $4 2>/dev/null" </dev/null
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
  printf '%s\n' "${polled[@]}" |
    on "$1" "if test -e /etc/chorus/fusion.json; then cat >/dev/null; else chorus init fusion --sensors-from -$wishes 2>/dev/null; fi"
  on "$1" "systemctl restart chorus-fusion" </dev/null
}

lay_out() {
  [[ -x "$packages/install.sh" ]] || fail "there are no packages in $packages: deploy/make-packages.sh makes them"
  polled=()
  local role host address id device
  for entry in "${hosts[@]}"; do
    read -r role host address id device <<<"$entry"
    reach "$host"
    packages_for "$host" >/dev/null
  done
  step "authority $fusion_host"
  lay_out_authority "$fusion_host" "$fusion_address"
  for entry in "${hosts[@]}"; do
    read -r role host address id device <<<"$entry"
    step "$role $host"
    if [[ $role == sensor ]]; then lay_out_sensor "$host" "$address" "$id" "$device"; else lay_out_fusion "$host"; fi
  done
  step "laid out; next: $0 $inventory check, then walk through the room (chorus register on the fusion host)"
}

renew() {
  local role host address rest
  found_authority
  for entry in "${hosts[@]}"; do
    read -r role host address rest <<<"$entry"
    step "$role $host"
    certify "$host" "$address" --renew
    on "$host" "systemctl reload chorus-$role" </dev/null
  done
  step "new certificates on ${#hosts[@]} hosts"
}

check() {
  local role host rest bad=0
  for entry in "${hosts[@]}"; do
    read -r role host rest <<<"$entry"
    step "$role $host"
    on "$host" "chorus doctor" </dev/null || bad=$(( bad + 1 ))
  done
  (( bad == 0 )) || fail "$bad of ${#hosts[@]} hosts are not well; what to do stands above"
  step "all ${#hosts[@]} hosts are well"
}

take_away() {  # remove|purge
  local role host rest
  for entry in "${hosts[@]}"; do
    read -r role host rest <<<"$entry"
    step "$role $host"
    on "$host" "DEBIAN_FRONTEND=noninteractive apt-get -q -y $1 'chorus-*' && rm -rf $there /etc/chrony/conf.d/chorus.conf" </dev/null
  done
}

case $task in
  lay-out) lay_out ;;
  check) check ;;
  renew) renew ;;
  remove|purge) take_away "$task" ;;
  *) usage >&2; fail "unknown task $task" ;;
esac
