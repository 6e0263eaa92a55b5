#!/usr/bin/env bash
# Makes the documentation's site in build/site/index.html: README.md and docs/*.md as pages, and the API
# reference. Installs Debian's pandoc and doxygen where they are missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$root"
packages=(pandoc doxygen)
install_packages
site=$root/build/site
rm -rf "$site"
mkdir -p "$site"
cp -r docs/pictures "$site/"

# In the order of reading; what is not named comes after.
order=(README tutorial model_file conventions catalogue adding_an_element plugins python results report theory
       which_method sweep parameter_study fidelity study validation performance gallery coming_from architecture)
pages=()
for name in "${order[@]}"; do
  for file in "$name.md" "docs/$name.md"; do
    if [ -f "$file" ]; then pages+=("$file"); fi
  done
done
for file in docs/*.md CHANGELOG.md; do
  case " ${pages[*]} " in *" $file "*) ;; *) pages+=("$file") ;; esac
done

page_name() {
  local name
  name=$(basename "$1" .md | tr '[:upper:]' '[:lower:]')
  echo "${name/#readme/index}.html"
}
title() { sed -n 's/^# //p' "$1" | head -n 1; }

navigation=""
for file in "${pages[@]}"; do
  navigation+="<a href=\"$(page_name "$file")\">$(title "$file")</a>"$'\n'
done
navigation+='<a href="api/index.html">API reference</a>'
for file in "${pages[@]}"; do
  pandoc -f gfm+tex_math_dollars -t html5 --mathml --lua-filter docs/site/links.lua --template docs/site/page.html \
    --variable navigation="$navigation" --metadata pagetitle="$(title "$file")" \
    -o "$site/$(page_name "$file")" "$file"
done
{ cat docs/site/Doxyfile; echo "OUTPUT_DIRECTORY = build/site"; } | doxygen - || fail "doxygen failed"
[ -f "$site/api/index.html" ] || fail "doxygen made no page"

# A link that leads nowhere, or a picture that is not there.
broken=$(cd "$site" && grep -oE '(href|src)="[^"#:]+[#"]' ./*.html | sed -E 's/^[^:]*:(href|src)="//; s/["#]$//' |
  sort -u | while read -r target; do [ -e "$target" ] || echo "$target"; done)
[ -z "$broken" ] || fail "the site links to what is not there: $broken"
echo "The site is $site/index.html"
