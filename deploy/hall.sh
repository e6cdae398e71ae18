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
def word(value, what):
    if not isinstance(value, str) or not re.fullmatch(r"[A-Za-z0-9_.:@/\[\]-]+", value) or value.startswith("-"):
        wrong(f"{what} is {value!r}; it needs letters, digits and _ . : @ / - only, and does not begin with -")
    return value
whole = read(file)
if not isinstance(whole, dict) or not isinstance(whole.get("cells"), dict) or len(whole["cells"]) < 2:
    wrong('needs "cells": the inventory of each of two or more cells, by its name')
for key in whole:
    if key not in ("name", "server", "cells", "places"):
        wrong(f"has the unknown key {key!r}; it takes name, server, cells, places")
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,63}")
cells = whole["cells"]
for name in [whole.get("name", ""), *cells]:
    if not isinstance(name, str) or not NAME.fullmatch(name):
        wrong(f'the name {name!r} is not of 1 to 64 letters, digits, _ or -, with no - before the others ("name" is the hall\'s)')
server = whole.get("server")
if not isinstance(server, str) or server not in cells:
    wrong(f'"server" is {server!r}; it is one of {", ".join(cells)}, on whose fusion host the server is to run')
places = whole.get("places", "places.json")
if not isinstance(places, str) or not places.isprintable() or not places.strip() or places.startswith("-"):
    wrong(f'"places" is {places!r}; it is the name of a file, such as "places.json"')
print("name", whole["name"])
print("places", file.parent / places)
entered = {}
for cell in [server] + [each for each in cells if each != server]:
    inventory = file.parent / word(cells[cell], f"the inventory of cell {cell}")
    word(str(inventory), f"the path of cell {cell}'s inventory")
    content = read(inventory)
    fusion = content.get("fusion") if isinstance(content, dict) else None
    if not isinstance(fusion, dict):
        wrong(f'{inventory}: needs an object "fusion", as in docs/guide/workshop.md')
    if "address" not in fusion:
        wrong(f'{inventory}: fusion has no "address": that under which the other hosts reach it, such as 10.0.0.10')
    address = word(fusion["address"], f"{inventory}: fusion.address")
    ssh = word(fusion.get("ssh", "root@" + address), f"{inventory}: fusion.ssh")
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

# The server's accounts are made once; what is there is kept.  A server that runs already takes new ones when it is started again.
start_server() {
  local cell rest wishes=''
  for entry in "${cells[@]}"; do read -r cell rest <<<"$entry"; wishes+=" --cell $cell"; done
  step "server on $server_host"
  on "$server_host" "command -v nats-server >/dev/null || test -x /usr/sbin/nats-server || DEBIAN_FRONTEND=noninteractive apt-get -q -y install nats-server" </dev/null
  # Debian starts its own nats-server.service on the port that the cells' server needs.  Whoever has changed its configuration uses it.
  on "$server_host" "dpkg --verify nats-server 2>/dev/null | grep -q /etc/nats-server.conf || ! systemctl cat nats-server.service >/dev/null 2>&1 || systemctl disable --now nats-server.service" </dev/null
  on "$server_host" "test -e /etc/chorus/site/nats-server.conf || { chorus init site --name $name$wishes --address $server_address >/dev/null && systemctl restart chorus-site; }" </dev/null
  on "$server_host" "systemctl enable --now chorus-site" </dev/null
  # One that ends at once is started again and again, so it is looked at more than once.
  on "$server_host" "for i in 1 2 3; do sleep 0.5; systemctl is-active --quiet chorus-site || exit 1; done" </dev/null ||
    fail "the server does not run on $server_host: journalctl -u chorus-site there says why (is port 4222 taken by another program?); mend that and run this again"
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

# Whether a configuration on standard input has a section "site": 0, or 1, or 2 if it cannot be read.  Comments do not count.
has_site() {
  python3 -c '
import json, re, sys
text = re.sub(r"(\"(?:\\.|[^\"\\])*\")|//[^\n]*|/\*.*?\*/", lambda match: match.group(1) or " ", sys.stdin.read(), flags=re.DOTALL)
try:
    sys.exit(0 if "site" in json.loads(text) else 1)
except ValueError as error:
    print(error, file=sys.stderr)
    sys.exit(2)'
}

# May be repeated after a break: the section is written and taken into use in one step, after all it names.
join_cell() {  # CELL SSH
  local kept code=0
  step "cell $1 joins"
  on "$server_host" "cat /etc/chorus/tls/ca.crt 2>/dev/null || true" </dev/null |
    on "$2" "cat > /etc/chorus/site-ca.crt.new && if test -s /etc/chorus/site-ca.crt.new; then mv /etc/chorus/site-ca.crt.new /etc/chorus/site-ca.crt; else rm /etc/chorus/site-ca.crt.new; fi"
  kept=$(on "$2" "cat /etc/chorus/fusion.json" </dev/null) || fail "cell $1 has no configuration on $2: lay it out first ($0 $hall lay-out)"
  printf '%s\n' "$kept" | has_site || code=$?
  case $code in
    0) echo "it has a section \"site\" already, which is kept"; return ;;
    1) ;;
    *) fail "/etc/chorus/fusion.json of $2 cannot be read; why stands above" ;;
  esac
  on "$server_host" "test -e /etc/chorus/site/$1.json" </dev/null ||
    fail "the server on $server_host has no account for cell $1: remove /etc/chorus/site there and the section \"site\" of each cell, and run this again (docs/guide/hall.md, Many cells)"
  on "$2" "test -e /etc/chorus/places.json || echo '{\"cells\": {}}' > /etc/chorus/places.json" </dev/null
  # The password passes through our pipe, never through a command line or a file of ours.
  on "$server_host" "cat /etc/chorus/site/$1.json" </dev/null | cell_file |
    on "$2" "umask 077; t=\$(mktemp -d) && trap 'rm -rf \$t' EXIT && cat > \$t/cell.json && chorus init site --join \$t/cell.json >/dev/null && systemctl restart chorus-fusion"
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
