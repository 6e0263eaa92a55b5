#!/usr/bin/env bash
# browser_test.sh DREV [--break|--hostile|--hostile-break|--sweep MODELS|--run-up MODELS|--run-up-break MODELS]: opens reports in Chromium, without a window, and does there what a reader
# does (probe.html). --break: with a page that loses peaks and has an error, which must be found.
# --hostile: with 200 names that are attacks (hostile_model.sh, hostile_probe.html), with the page's policy and
# without it, alone and compared, and printed. --hostile-break: with a page that takes them for markup.
#
# --sweep: the reports of a sweep, of one with branches and of a class calculation of the models in that folder, and of a
# study of many variants (sweep_probe.html, branches_probe.html, variants_probe.html).
# --run-up: the report of a start-up with its waterfall (waterfall_probe.html). --run-up-break: with crowded labels and
# a scale without its unit, which must be found.
# Checked: no error, no request, all charts with the right number of points, none of which loses a peak, zoom
# by mouse, wheel, keys and buttons, choice of a mode, themes, paper; sizes below 5 MB; a comparison; a PDF.
# Prints how long the page took until it could be used, and checks nothing of that.
set -euo pipefail
drev=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "SKIPPED: no Chromium here (Debian's package: chromium)"
  exit 77
fi
if [[ $(readlink -f "$browser") = *snap* ]] || head -c 4000 "$browser" | grep -aq /snap/; then
  echo "SKIPPED: Chromium is a snap here, which sees neither /tmp nor most other folders"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0

fail() {
  echo "FAILED: $*"
  failed=1
}

headless() {
  local root=()
  [ "$(id -u)" != 0 ] || root=(--no-sandbox)
  timeout 280 "$browser" --headless --disable-gpu --no-first-run "${root[@]}" --enable-logging=stderr \
    --user-data-dir="$folder/profile" "$@"
}

# probe <page> <name> [<probe>]: runs the probe in the page, which the page's policy must let run, and shows what
# it found.
probe() {
  local page=$folder/probed.html found=$folder/found.txt log=$folder/log.txt nonce
  nonce=$(grep -om1 "'nonce-[^']*'" "$1" | sed "s/'nonce-//; s/'//" || true)
  sed "/<meta charset/r $here/collect.html" "$1" >"$page"
  sed "s|^<script>|<script nonce=\"$nonce\">|" "$here/${3:-probe.html}" >>"$page"
  local budget=60000  # ms of the page's time; what waits for pictures polls
  [[ ${3:-} != @(sweep|branches|variants|waterfall)_probe.html ]] || budget=1200000
  headless --window-size=1280,1000 --virtual-time-budget=$budget --dump-dom "file://$page" \
    >"$folder/dom.html" 2>"$log" || {
    fail "$2: the browser ended with an error"
    tail -n 5 "$log"
    return
  }
  sed -n '/<pre id="probe">/,/<\/pre>/p' "$folder/dom.html" | sed 's/<[^>]*>//g' >"$found"
  sed "s/^/$2: /" "$found" | grep -v ": $" || true
  grep -q "^done" "$found" || fail "$2: the probe did not come to its end"
  ! grep "^FAILED" "$found" || failed=1
  ! grep -E "CONSOLE.*(Uncaught|Error)" "$log" || fail "$2: errors on the console"
}

below_5_MB() {
  local size
  size=$(stat -c %s "$1")
  echo "$(basename "$1"): $size bytes"
  [ "$size" -lt 5000000 ] || fail "$(basename "$1") has $size bytes"
}

cd "$folder"
if [[ ${2:-} = --hostile* ]]; then
  "$here/hostile_model.sh" hostile.toml
  "$drev" run hostile.toml --report hostile.html --quiet
  sed '/http-equiv="Content-Security-Policy"/d' hostile.html >open.html
  if [ "$2" = --hostile-break ]; then
    sed -i 's/^const asMarkup = .*/const asMarkup = String;/' open.html
    probe open.html broken hostile_probe.html
    exit $failed
  fi
  probe hostile.html hostile hostile_probe.html
  probe open.html "without a policy" hostile_probe.html
  "$drev" run hostile.toml --set torque_Nm=10 --report other.html --quiet
  "$drev" report hostile.html other.html --out both.html --quiet
  probe both.html compared hostile_probe.html
  "$drev" report hostile.html --out hostile.pdf --quiet
  [ "$(head -c 5 hostile.pdf)" = "%PDF-" ] || fail "hostile.pdf is no PDF"
  [ -z "$(ls | grep -E "partial|print" || true)" ] || fail "files of printing are left: $(ls)"
  exit $failed
fi
if [[ ${2:-} = --run-up* ]]; then
  "$drev" run "$3/genset/start.toml" --report start.html --quiet
  if [ "$2" = --run-up-break ]; then
    sed -i -e 's/pixelsPerLabel: 55,/pixelsPerLabel: 12,/' \
      -e 's/\(a height of 1 order is ${sig((most \* readable.factor) \/ height, 3)}\) ${readable.unit}/\1/' start.html
    probe start.html broken waterfall_probe.html
    exit $failed
  fi
  below_5_MB start.html
  probe start.html start waterfall_probe.html
  exit $failed
fi
if [ "${2:-}" = --sweep ]; then
  "$drev" sweep "$3/engine/engine.toml" --speeds 600:10:2000 --report sweep.html --quiet
  probe sweep.html sweep sweep_probe.html
  cat >chain.toml <<'END'
format = 1
nodes = { electric_motor_rotor = { constant_speed_rpm = 600 }, coupling_hub_motor_side = {}, gearbox_input_shaft_end = {} }
[elements]
hub = { type = "inertia", node = "coupling_hub_motor_side", inertia_kg_m2 = 1 }
shaft_end = { type = "inertia", node = "gearbox_input_shaft_end", inertia_kg_m2 = 1 }
motor_shaft = { type = "shaft_spring", nodes = ["electric_motor_rotor", "coupling_hub_motor_side"], stiffness_Nm_per_rad = 100, damping_Nms_per_rad = 1 }
gear_shaft = { type = "shaft_spring", nodes = ["coupling_hub_motor_side", "gearbox_input_shaft_end"], stiffness_Nm_per_rad = 100, damping_Nms_per_rad = 1 }
gas = { type = "engine_order_torque", node = "gearbox_input_shaft_end", harmonics = { order = [0.5, 1], amplitude_Nm = [1, 1] } }
[run]
duration_s = 1
END
  "$drev" sweep chain.toml --speeds 20:20:400 --report chain.html --quiet
  probe chain.html "long names" sweep_probe.html
  "$drev" class "$3/genset/genset.toml" --speeds 1200:20:1700 --contact closed --report class.html --quiet
  probe class.html class sweep_probe.html
  "$drev" sweep "$3/gear_pair/gear_pair.toml" --speeds 1500:100:2500 --report branches.html --quiet
  probe branches.html branches branches_probe.html
  "$drev" run gear_drive --vary 'backlash_mm=uniform(0.1,0.2)' --vary 'engine_rpm=normal(750,10)' \
    --sample saltelli:128 --step 2e-5 --duration 0.02 --out table --report variants.html --quiet
  below_5_MB variants.html
  probe variants.html variants variants_probe.html
  exit $failed
fi
"$drev" run camshaft --every 5e-6 --report main.html --quiet  # a million samples
if [ "${2:-}" = --break ]; then
  sed -i -e 's/if (series.high\[i\] > high) high = series.high\[i\];/if (series.low[i] > high) high = series.low[i];/' \
    -e 's/^ *window.drevCharts/setTimeout(() => nothing.at.all); &/' main.html
  probe main.html broken
  exit $failed
fi
below_5_MB main.html
probe main.html main
# In real time, as a reader waits.
headless --dump-dom "file://$folder/main.html" 2>/dev/null |
  sed -n 's/.*data-ready="\([0-9]*\)".*/ready after \1 ms/p'

"$drev" run gear_drive --report first.html --quiet
"$drev" run gear_drive --set backlash_mm=0.3 --step 1e-5 --report second.html --quiet
"$drev" report first.html second.html --out both.html --quiet
below_5_MB both.html
probe both.html both
"$drev" run two_mass_backlash --report short.html --quiet
probe short.html short

"$drev" report main.html --out main.pdf --quiet
[ "$(head -c 5 main.pdf)" = "%PDF-" ] || fail "main.pdf is no PDF"
below_5_MB main.pdf
[ "$(stat -c %s main.pdf)" -gt 200000 ] || fail "main.pdf is too small to have the charts in it"
[ -z "$(ls | grep partial || true)" ] || fail "partial files are left: $(ls)"
exit $failed
