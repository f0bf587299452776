# SPDX-License-Identifier: Apache-2.0
# bash completion for mgt, mgtd and mgt-rig. It asks the program itself (--help), so it cannot fall behind it.

# _mgt_words PROGRAM [SUBCOMMAND...]: the options and subcommands that --help lists.
_mgt_words() {
  "$@" --help 2>/dev/null | awk '
    /^(Subcommands|SUBCOMMANDS):/ { inside = 1; next }
    /^[^ ]/ { inside = 0 }
    inside && /^  [a-z]/ { print $1 }
    { line = $0; while (match(line, /(^|[ ,])--[a-z][a-z-]*/)) {
        word = substr(line, RSTART, RLENGTH); sub(/^[ ,]/, "", word); print word
        line = substr(line, RSTART + RLENGTH) } }'
}

_mgt() {
  local current=${COMP_WORDS[COMP_CWORD]} path=("${COMP_WORDS[0]}") word known
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == [a-z]* ]] || continue
    known=$(_mgt_words "${path[@]}")
    grep -qxF -- "$word" <<<"$known" && path+=("$word")
  done
  mapfile -t COMPREPLY < <(compgen -W "$(_mgt_words "${path[@]}")" -- "$current")
  [[ $current == -* ]] || mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _mgt mgt mgtd mgt-rig
