# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# What may follow in `glint` and `glintd` on bash's command line: it asks --help, so it cannot be out of date.

_glint() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]}
  local help command=()
  if [ "${program##*/}" = glint ] && [ "$COMP_CWORD" -gt 1 ]; then
    command=("${COMP_WORDS[1]}")
  fi
  COMPREPLY=()
  help=$("$program" "${command[@]}" --help 2>/dev/null) || return 0

  # A value: one of those in braces behind the option, else a file.
  if [[ $before == --* ]]; then
    local option choices
    option=$(grep -E -- "^ +(-[a-zA-Z],)?$before( |\$)" <<<"$help")
    choices=$(sed -n 's/^[^{]*:{\([^}]*\)}.*/\1/p' <<<"$option")
    if [ -n "$choices" ]; then
      mapfile -t COMPREPLY < <(compgen -W "${choices//,/ }" -- "$word")
      return 0
    fi
    # An option with a value names its type: TEXT, INT, FLOAT, ...
    if [[ $option =~ ^\ +[^\ ]+\ [A-Z]{2,} ]]; then
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return 0
    fi
  fi

  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '^ +(-[a-zA-Z],)?--[a-z0-9-]+' <<<"$help" |
      grep -oE -- '--[a-z0-9-]+')" -- "$word")
  elif [ ${#command[@]} -eq 0 ] && [ "${program##*/}" = glint ]; then
    mapfile -t COMPREPLY < <(compgen -W "$(sed -n '/^Subcommands:/,$s/^  \([a-z-]*\) .*/\1/p' <<<"$help")" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _glint glint glintd
