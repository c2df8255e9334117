#compdef mixloop mixloop-plant mixloop-controller mixloop-planner
# Completion of mixloop and its processes in zsh: commands and options as --help names them, files else.
local -a call=($words[1]) names
local help word
for word in ${words[2,CURRENT-1]}; do
  if [[ ${words[1]:t} == mixloop && $word != -* ]]; then call+=($word); break; fi
done
help=$($call --help 2>/dev/null) || return
if [[ $words[CURRENT] == -* ]]; then
  names=(${(fu)"$(grep -oE -- '--[a-z][a-z-]*' <<<$help)"})
  compadd -- $names
elif [[ ${words[1]:t} == mixloop && $#call == 1 ]]; then
  names=(${(f)"$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<$help)"})
  compadd -- $names
else
  _files
fi
