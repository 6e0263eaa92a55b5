# Completion of drev's commands, options, models, parameters and channels in bash; files where none fits.
_drev() {
  local line=${COMP_LINE:0:COMP_POINT} words
  read -ra words <<<"$line"
  if [[ $line == *' ' ]]; then words+=(''); fi
  local word=${words[-1]} offered
  mapfile -t offered < <("${words[0]}" __complete "${words[@]:1}" 2>/dev/null)
  # Bash has split the word at = and :, and replaces only what is behind them.
  local kept=${word%"${COMP_WORDS[COMP_CWORD]}"}
  if [[ ${COMP_WORDS[COMP_CWORD]} == [=:] ]]; then kept=$word; fi
  COMPREPLY=("${offered[@]#"$kept"}")
  if [ ${#COMPREPLY[@]} = 1 ] && [[ ${COMPREPLY[0]} == *= ]]; then compopt -o nospace; fi
}
complete -o default -F _drev drev
