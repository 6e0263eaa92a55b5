#!/usr/bin/env bash
# Measures the methods on five models and writes the charts and tables of docs/which_method.md. Takes some
# minutes; timings want a machine that does nothing else.
#
#   scripts/charts.sh [drev] [seconds of the longest run drawn]     e.g. scripts/charts.sh build/release/bin/drev 4
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
drev="${1:-$root/build/release/bin/drev}"
limit="${2:-2}"
page="$root/docs/which_method.md"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

# chart NAME MODEL [parameters]: docs/pictures/which_NAME.svg, which_NAME_work.svg, and the table between
# <!-- NAME --> and <!-- end --> in the page.
chart() {
  local name="$1"
  shift
  echo "$name"
  {
    echo '```'
    echo "drev chart $*"
    "$drev" chart "$@" --limit "$limit" --out "$folder" | sed '1,/^$/d'
    echo '```'
  } > "$folder/table"
  cp "$folder/error_over_time.svg" "$root/docs/pictures/which_$name.svg"
  cp "$folder/error_over_work.svg" "$root/docs/pictures/which_${name}_work.svg"
  awk -v name="$name" -v table="$folder/table" '
    inside && /^<!-- end -->$/ { inside = 0 }
    !inside { print }
    $0 == "<!-- " name " -->" { while ((getline line < table) > 0) print line; inside = 1 }' \
    "$page" > "$folder/page"
  cp "$folder/page" "$page"
}

chart camshaft_held camshaft --set drive=held
chart camshaft_gears camshaft
chart two_mass_backlash two_mass_backlash
chart stiff_mesh gear_drive --set mesh_stiffness_factor=1000
chart soft_mesh gear_drive --set mesh_stiffness_factor=0.01
