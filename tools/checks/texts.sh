# SPDX-License-Identifier: Apache-2.0
# texts.sh - sourced by check: its stages that read the tree as text, format and layering.
#
# What checks a file by itself reads those that have changed since it passed (changed.sh); a rule of the whole tree
# reads all. The caller has $root, $again and a function `tracked`: git in $root.

sources() { find "$root"/{firmware,hal,host,model,tests,tools} \
  \( -name node_modules -prune \) -o \( -name '*.h' -o -name '*.cc' \) -print; }
python_sources() { { tracked grep -lzE '^#!.*[/ ]python3$'; tracked ls-files -z '*.py'; } | sort -zu; }
shell_sources() { tracked grep -lzE '^#!.*[/ ](sh|bash)$'; }

# on_cores FILES_A_CALL COMMAND... -- FILE...: as many calls at a time as there are cores
on_cores() {
  local many=$1 command=()
  shift
  while [ "$1" != -- ]; do command+=("$1"); shift; done
  shift
  [ $# -eq 0 ] || printf '%s\0' "$@" | xargs -0 -n "$many" -P "$(nproc)" "${command[@]}"
}

format() {
  local files
  mapfile -t files < <(sources)
  any_newer format "$root/.clang-format" || mapfile -t files < <(newer_of format "${files[@]}")
  begin_stage format
  on_cores 64 clang-format-22 --dry-run -Werror -- "${files[@]}"
  pass_stage format
}

layering() {
  local rules=(layering tree sources readme ladder units words hazards clones bench budgets pictures provenance)
  cd "$root" || return
  # what tries the check's own functions
  [ $again = yes ] && ! any_newer layering tools/{check,checks} tests/house ||
    rules=(changed stages "${rules[@]}")
  begin_stage layering
  rules=("${rules[@]/#/tests/house/}")
  on_cores 1 python3 -- "${rules[@]/%/_test.py}"
  tests/mutations/run --check
  tools/numbers  # of the READMEs: those of the files of results?
  lint
  pass_stage layering
}

# A shell script is checked with those that it sources.
lint() {
  local shell python
  mapfile -d '' -t shell < <(shell_sources)
  [ $again = no ] || any_newer layering tools/{,checks/}*.sh "${shell[@]}" || shell=()
  mapfile -d '' -t python < <(python_sources)
  mapfile -t python < <(newer_of layering "${python[@]}")
  on_cores 8 shellcheck -x -S warning -- "${shell[@]}"
  on_cores 40 pyflakes3 -- "${python[@]}"
  # not W504: the operator is before the break here, as in the other languages
  on_cores 40 pycodestyle --max-line-length=130 --ignore=W504 --show-source -- "${python[@]}" ||
    { echo "not in style: repair these lines by hand (PEP 8, 130 columns; a line breaks after its operator)"; return 1; }
}
