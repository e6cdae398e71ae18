#!/usr/bin/env bash
# Makes one hall of several cells, each with an inventory of its own (workshop.sh), over ssh.
#
#   deploy/hall.sh HALL lay-out    lays out each cell, starts the site's server, and joins the cells; if repeated, updates them
#   deploy/hall.sh HALL join       the same without laying out the cells
#   deploy/hall.sh HALL places     gives every cell the file of places, used without a restart
#   deploy/hall.sh HALL check      runs workshop.sh check on each cell
#
# HALL is a JSON file, as in docs/guide/hall.md: {"name": "hall", "server": "a", "cells": {"a": "cell-a.json", "b": "cell-b.json"}, "places": "places.json"}.
# Inventories and places are named from where HALL is. The server runs on the fusion host of the cell "server".
# CHORUS_SSH replaces `ssh`, as in workshop.sh.
set -Eeuo pipefail

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\nhall: %s\n' "$*" >&2; exit 1; }

read -ra ssh_command <<<"${CHORUS_SSH:-ssh -o BatchMode=yes -o ConnectTimeout=10}"
on() { "${ssh_command[@]}" "$1" "$2"; }

[[ $# == 2 ]] || { usage >&2; exit 2; }
hall=$1 task=$2
readonly here=$(dirname "$0")
[[ -f "$hall" ]] || fail "there is no file $hall: write one as in docs/guide/hall.md (Many cells)"
case $task in lay-out|join|places|check) ;; *) usage >&2; fail "unknown task $task" ;; esac

# Lines "name NAME", "places FILE", then "CELL INVENTORY SSH ADDRESS" of each cell, that of the server first.
read_hall() {
  python3 - "$hall" <<'PYTHON'
import json, pathlib, re, sys
file = pathlib.Path(sys.argv[1])
def wrong(why):
    sys.exit(f"\nhall: {file}: {why}")
def read(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        wrong(f"{path}: {error}")
whole = read(file)
if not isinstance(whole, dict) or not isinstance(whole.get("cells"), dict) or len(whole["cells"]) < 2:
    wrong('needs "cells": the inventory of each of two or more cells, by its name')
for key in whole:
    if key not in ("name", "server", "cells", "places"):
        wrong(f"has the unknown key {key!r}; it takes name, server, cells, places")
WORD = re.compile(r"[A-Za-z0-9_-]{1,64}")
cells = whole["cells"]
for name in [whole.get("name", ""), *cells]:
    if not isinstance(name, str) or not WORD.fullmatch(name):
        wrong(f'the name {name!r} is not of 1 to 64 letters, digits, _ or - ("name" is the hall\'s)')
server = whole.get("server")
if server not in cells:
    wrong(f'"server" is {server!r}; it is one of {", ".join(cells)}, on whose fusion host the server is to run')
print("name", whole["name"])
print("places", file.parent / whole.get("places", "places.json"))
entered = {}
for cell in [server] + [each for each in cells if each != server]:
    inventory = file.parent / cells[cell]
    fusion = read(inventory).get("fusion", {})
    address = fusion.get("address", "")
    ssh = fusion.get("ssh", f"root@{address}")
    if any(not isinstance(word, str) or not re.fullmatch(r"[A-Za-z0-9_.:@/\[\]-]+", word) for word in (address, ssh, str(inventory))):
        wrong(f"{inventory}: fusion.address is missing, or a word has letters other than A-Z a-z 0-9 _ . : @ / -")
    if ssh in entered:
        wrong(f"cells {entered[ssh]} and {cell} are the same host, {ssh}; a cell needs a fusion host of its own")
    entered[ssh] = cell
    print(cell, inventory, ssh, address)
PYTHON
}

cells=() name='' places=''
lines=$(read_hall) || exit 1
while read -r first rest; do
  case $first in
    name) [[ -n $name ]] && cells+=("$first $rest") || name=$rest ;;
    places) [[ -n $places ]] && cells+=("$first $rest") || places=$rest ;;
    *) cells+=("$first $rest") ;;
  esac
done <<<"$lines"
read -r _ _ server_host server_address <<<"${cells[0]}"

each_workshop() {  # TASK
  local cell inventory rest bad=0
  for entry in "${cells[@]}"; do
    read -r cell inventory rest <<<"$entry"
    step "cell $cell: $1"
    "$here/workshop.sh" "$inventory" "$1" || bad=$(( bad + 1 ))
    (( bad == 0 )) || [[ $1 == check ]] || fail "cell $cell was not laid out; mend that and run this again"
  done
  (( bad == 0 )) || fail "$bad of ${#cells[@]} cells are not well; what to do stands above"
}

# The server's accounts are made once; what is there is kept.
start_server() {
  local cell rest wishes=''
  for entry in "${cells[@]}"; do read -r cell rest <<<"$entry"; wishes+=" --cell $cell"; done
  step "server on $server_host"
  on "$server_host" "command -v nats-server >/dev/null || test -x /usr/sbin/nats-server || DEBIAN_FRONTEND=noninteractive apt-get -q -y install nats-server" </dev/null
  on "$server_host" "test -e /etc/chorus/site/nats-server.conf || chorus init site --name $name$wishes --address $server_address >/dev/null" </dev/null
  on "$server_host" "systemctl enable --now chorus-site" </dev/null
}

# What a cell needs: its section, with the authority of the server beside its own and the file of places.  Standard input: CELL.json.
cell_file() {
  python3 -c '
import json, sys
whole = json.load(sys.stdin)
if whole["site"].get("ca"):
    whole["site"]["ca"] = "/etc/chorus/site-ca.crt"
whole["site"]["places"] = "/etc/chorus/places.json"
json.dump(whole, sys.stdout, indent=2)'
}

join_cell() {  # CELL SSH
  step "cell $1 joins"
  if on "$2" "grep -q '\"site\"' /etc/chorus/fusion.json" </dev/null; then echo "it has a section \"site\" already, which is kept"; return; fi
  on "$server_host" "cat /etc/chorus/tls/ca.crt 2>/dev/null || true" </dev/null | on "$2" "cat > /etc/chorus/site-ca.crt"
  on "$2" "test -e /etc/chorus/places.json || echo '{\"cells\": {}}' > /etc/chorus/places.json" </dev/null
  # The password passes through our pipe, never through a command line or a file of ours.
  on "$server_host" "cat /etc/chorus/site/$1.json" </dev/null | cell_file |
    on "$2" "umask 077; t=\$(mktemp -d) && trap 'rm -rf \$t' EXIT && cat > \$t/cell.json && chorus init site --join \$t/cell.json >/dev/null"
  on "$2" "systemctl restart chorus-fusion" </dev/null
}

join() {
  local cell inventory host rest
  start_server
  for entry in "${cells[@]}"; do
    read -r cell inventory host rest <<<"$entry"
    join_cell "$cell" "$host"
  done
  if [[ -f $places ]]; then give_places; else step "joined; next: chorus site register ... --out $places, then $0 $hall places (docs/guide/hall.md)"; fi
}

give_places() {
  local cell inventory host rest
  [[ -f $places ]] || fail "there is no file $places: chorus site register writes it (docs/guide/hall.md)"
  for entry in "${cells[@]}"; do
    read -r cell inventory host rest <<<"$entry"
    step "cell $cell: places"
    on "$host" "cat > /etc/chorus/places.json.new && mv /etc/chorus/places.json.new /etc/chorus/places.json && systemctl reload chorus-fusion" < "$places"
  done
}

case $task in
  lay-out) each_workshop lay-out; join ;;
  join) join ;;
  places) give_places ;;
  check) each_workshop check ;;
esac
