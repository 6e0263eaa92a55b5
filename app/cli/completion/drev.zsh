#compdef drev
# Completion of drev's commands, options, models, parameters and channels in zsh; files where none fits.
local -a offered
offered=("${(@f)$("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
if (( ${#offered} )) && [[ -n ${offered[1]} ]]; then
  compadd -S '' -- "${offered[@]}"
else
  _files
fi
