#!/usr/bin/env bash
# Writes the table "Size of the rooms" of docs/architecture.md again: of each room of tests/tree/rooms.cmake the number of
# source and header files, the median of their lines, and the largest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
page=docs/architecture.md
rooms=$(sed -n 's/^  "\([a-z/_]*\):.*/\1/p' tests/tree/rooms.cmake | tr '\n' ' ')
table=$(
  git ls-files '*.cpp' '*.hpp' '*.h' | xargs wc -l | awk -v rooms="$rooms" '
    BEGIN { n = split(rooms, list, " "); for (i = 1; i <= n; ++i) is_room[list[i]] = 1 }
    $2 == "total" { next }
    {
      folder = $2
      while (sub(/\/[^\/]*$/, "", folder) && !(folder in is_room)) {}
      if (folder in is_room) print folder "\t" $1 "\t" $2
    }' | sort -t "$(printf '\t')" -k1,1 -k2,2n | awk -F '\t' '
    function flush() {
      if (room == "") return
      name = file[count]
      sub(/.*\//, "", name)
      printf "| `%s/` | %d | %d | %d, `%s` |\n", room, count, lines[int((count + 1) / 2)], lines[count], name
    }
    $1 != room { flush(); room = $1; count = 0 }
    { lines[++count] = $2; file[count] = $3 }
    END { flush() }'
)
awk -v table="$table" '
  /^\| room \| files \| median \| largest \|$/ { print; getline; print; print table; skipping = 1; next }
  skipping && /^\|/ { next }
  { skipping = 0; print }' $page >$page.new
mv $page.new $page
