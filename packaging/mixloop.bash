# Completion of mixloop and its processes in bash: commands and options as --help names them, files else.
_mixloop() {
  local word=${COMP_WORDS[COMP_CWORD]} help i
  local -a call=("${COMP_WORDS[0]}")
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${call[0]##*/} == mixloop && ${COMP_WORDS[i]} != -* ]] && call+=("${COMP_WORDS[i]}") && break
  done
  help=$("${call[@]}" --help 2>/dev/null) || return
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)" -- "$word"))
  elif [[ ${call[0]##*/} == mixloop && ${#call[@]} == 1 ]]; then
    COMPREPLY=($(compgen -W "$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -o filenames -F _mixloop mixloop mixloop-plant mixloop-controller mixloop-planner
