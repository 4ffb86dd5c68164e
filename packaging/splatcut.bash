# Completion of splatcut, from what its --help says. What is no option, no command and none of a few words is a file:
# bash completes that itself.
_splatcut() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]} command= word words= help
  if [[ $current == = ]]; then
    current=
  elif [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  help=$("$program" --help 2>/dev/null)
  local commands=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")
  if [[ $COMP_CWORD -gt 1 ]]; then command=view; fi  # also of a scene without a command
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if grep -qxF -e "$word" <<<"$commands"; then command=$word; break; fi
  done
  if [[ -n $command ]]; then help+=$'\n'$("$program" $command --help 2>/dev/null); fi
  if [[ $before == -* ]]; then  # "  --edges TEXT:{clean,keep}=clean  ..."
    words=$(sed -nE "s/^  (-.,)?$before [A-Z]*:?\{([^}]*)\}.*/\2/p" <<<"$help" | tr , ' ')
  fi
  if [[ -z $words && $current == -* ]]; then
    words=$(sed -nE 's/^  ((-.),)?(--[a-z-]+).*/\2 \3/p' <<<"$help")
  elif [[ -z $words && -z $command ]]; then
    words=$commands
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _splatcut splatcut
