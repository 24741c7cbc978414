#!/bin/sh
# Proves the one-way dependencies:
#   sys <- mesh <- body <- {effect, pair, estimator} <- {loop, adaptor} <- recorder <- scene <- app
# A file may include headers of its own package and of packages to the left of it. The recorder, the app and the plugins include public
# headers only, and no code in src/ names a plugin (comments may; a text "NAME" alone is that of a plugin only where estimators are
# chosen). Prints every offence. `sh tests/deps.sh FOLDER` judges another tree.
cd "${1:-$(dirname "$0")/..}" || exit 2
exec awk -v plugins="$(ls plugins)" '
function rank(package) { return package in ranks ? ranks[package] : -1 }
function package_of(name) { return name == "retro" ? "sys" : name } # the header not named after a package
function fail(what) { printf "%s:%d: %s\n", FILENAME, FNR, what; bad = 1 }
function without_comments(line,    end) {
  if (comment) { if (!(end = index(line, "*/"))) return ""; line = substr(line, end + 2); comment = 0 }
  gsub(/\/\*([^*]|\*+[^*\/])*\*+\//, "", line)
  if (end = index(line, "/*")) { comment = 1; line = substr(line, 1, end - 1) }
  return line
}
BEGIN {
  n = split("sys:0 mesh:1 body:2 effect:3 pair:3 estimator:3 loop:4 adaptor:4 recorder:5 scene:6 app:7", list, " ")
  for (i = 1; i <= n; ++i) { split(list[i], p, ":"); ranks[p[1]] = p[2] }
  n = split(plugins, folder)
  for (i = 1; i <= n; ++i) { # folder estimator_zz: the strings "zz" and "...estimator_zz...", the macro ABUTESTIMATORZZ
    name = folder[i]; sub(/^[^_]*_/, "", name)
    macro = folder[i]; gsub(/_/, "", macro)
    alone[folder[i]] = "\"" name "\""
    named[folder[i]] = "\"[^\"]*" folder[i] "[^\"]*\"|ABUT" toupper(macro)
  }
}
# Which package a file belongs to: src/PACKAGE/..., include/abutPACKAGE.h, include/abut/private/PACKAGEimpl.h
FNR == 1 {
  comment = 0
  mine = FILENAME
  if (mine ~ /^plugins\//) mine = "a plugin"
  else { sub(/^src\//, "", mine); sub(/^include\/(abut\/private\/)?(abut)?/, "", mine); sub(/\/.*|(impl)?\.h$/, "", mine) }
  mine = mine == "" ? "app" : package_of(mine) # abut.h is everything
  if (mine != "a plugin" && rank(mine) < 0) fail("package " mine " is not in the list at the top of tests/deps.sh")
}
/^[ \t]*#[ \t]*include/ {
  header = $0
  sub(/^[^<"]*[<"]/, "", header); sub(/[>"].*/, "", header)
  theirs = header
  private = sub(/^(.*\/)?abut\/private\//, "", theirs)
  sub(/^abut/, "", theirs); sub(/(impl)?\.h$/, "", theirs)
  if (theirs == "retro") private = 0 # the public headers need it
  theirs = header == "abut.h" ? "app" : package_of(theirs)
  if (mine != "a plugin" && header ~ /plugins\//) fail("includes a file of a plugin: " header)
  if (rank(theirs) < 0 || (header !~ /^abut/ && !private)) next # not ours: PETSc, the C library, a header of the same folder
  if (mine != "a plugin" && theirs != mine && rank(theirs) >= rank(mine)) fail(mine " may not include " header)
  if (private && theirs != mine && mine ~ /^(recorder|app|a plugin)$/) fail(mine " includes public headers only: " header)
}
FILENAME ~ /^src\// {
  code = without_comments($0)
  chooses = FILENAME ~ /^src\/(estimator|adaptor|scene|app)\//
  for (plugin in named) if (code ~ named[plugin] || (chooses && code ~ alone[plugin])) fail("src/ names the plugin " plugin)
}
END { exit bad }
' $(find include src plugins -name '*.[ch]')
