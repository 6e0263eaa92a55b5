#!/usr/bin/env bash
# hostile_model.sh FILE: writes a model whose 200 nodes have names that a page could take for markup, a program, an
# address, a pattern or a name of its own; and so have its elements and its texts. A program that runs sets
# window.ran. (Names hold no full stop, comma, asterisk, double quote or control character, and in braces an
# expression: a model with others is refused.)
set -euo pipefail
attacks=(
  '<img src=x onerror=ran=1>' '<script>ran=1</script>' '</script><script>ran=1</script>' '<svg onload=ran=1>'
  '<svg><script>ran=1</script></svg>' '<iframe srcdoc="&lt;script>parent;ran=1&lt;/script>">'
  '<details open ontoggle=ran=1>' '<body onload=ran=1>' '<input autofocus onfocus=ran=1>' '<a href=javascript:ran=1>a</a>'
  '<style>@import url(x)</style>' '<link rel=stylesheet href=x>' '<base href=x>' '<form action=x><button>'
  '<meta http-equiv=refresh content=0>' '<math><mtext><img src=x onerror=ran=1>' '<!--<script>' '--><b>'
  'javascript:ran=1' '`ran=1`' '<embed src=x>' 'hasOwnProperty' '__proto__' 'constructor' '&lt;script&gt;ran=1&lt;/script&gt;'
)
before=('' "'>" '\">' '\\' $'\u2028' $'\u202e' '`' ']]>')
plain() { local text=${1//\"/}; printf %s "${text//[.,]/}"; }

{
  texts='\"></script><script>ran=1</script><img src=x onerror=\"ran=1\">{{program}}{{runs}}'
  echo 'format = 1'
  for key in name summary note; do
    value=$texts
    [ "$key" != name ] || value='</script><script>ran=1</script><img src=x onerror=ran=1>'
    echo "$key = \"$value\""
  done
  echo "[parameters]"
  echo "torque_Nm = { default = 20, meaning = \"$texts\" }"
  nodes=() number=0
  for prefix in "${before[@]}"; do
    for attack in "${attacks[@]}"; do
      nodes+=("$(printf %s "$(plain "$prefix")$(plain "$attack")" | sed -e 's/\\/\\\\/g')")
    done
  done
  echo '[nodes]'
  for node in "${nodes[@]}"; do
    [ "$number" = 0 ] && start='{ constant_speed_rpm = 600 }' || start='{}'
    echo "\"$node\" = $start"
    number=$((number + 1))
  done
  echo '[elements]'
  for i in "${!nodes[@]}"; do
    node=${nodes[$i]}
    echo "\"inertia $node\" = { type = \"inertia\", node = \"$node\", inertia_kg_m2 = 0.01 }"
    [ "$i" != 0 ] || continue
    last=${nodes[$((i - 1))]}
    if [ "$i" = 120 ]; then
      echo "\"$node\" = { type = \"gear_mesh\", nodes = [\"$last\", \"$node\"], base_radius_1_mm = 30, base_radius_2_mm = 75, teeth_1 = 20, stiffness_N_per_um = 100, normal_backlash_mm = 0.1 }"
    else
      echo "\"$node\" = { type = \"shaft_spring\", nodes = [\"$last\", \"$node\"], stiffness_Nm_per_rad = 1000, damping_Nms_per_rad = 0.1 }"
    fi
  done
  echo "\"$last load\" = { type = \"applied_torque\", node = \"$last\", harmonics = { frequency_Hz = [10], amplitude_Nm = [\"torque_Nm\"] } }"
  echo '[run]'
  echo 'duration_s = 0.2'
  echo 'record = ['
  for ((i = 0; i < ${#nodes[@]}; i += 8)); do echo "  \"${nodes[$i]}.angle_rad\","; done
  echo ']'
} >"$1"
