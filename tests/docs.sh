#!/usr/bin/env bash
# Holds the pages to what they name: links and their headings, files in backticks, the indexes of pages and examples, the room that
# pictures take. Run from the repository's root; prints every fault and fails where there is one.
set -u
export LC_ALL=C.UTF-8
faults=0
fault() {
  echo "$1"
  faults=$((faults + 1))
}

# Text of a page without fenced blocks.
prose() { awk '/^```/ { code = !code; next } !code' "$1"; }

# Anchors of a page's headings, as GitHub makes them.
anchors() { prose "$1" | sed -n 's/^#\+ *//p' | tr '[:upper:]' '[:lower:]' | sed 's/[^[:alnum:] _-]//g; s/ /-/g'; }

while read -r page; do
  folder=$(dirname "$page")
  while read -r link; do
    file=${link%%#*} anchor=
    case $link in http*) continue ;; *"#"*) anchor=${link#*#} ;; esac
    target=$page
    [ -z "$file" ] || target=$folder/$file
    [ -e "$target" ] || { fault "$page: '$link' leads nowhere"; continue; }
    [ -z "$anchor" ] || anchors "$target" | grep -qxF -- "$anchor" || fault "$page: '$link': no such heading"
  done < <(prose "$page" | grep -o '](\([^)]*\))' | sed 's/^](//; s/)$//')
  while read -r path; do
    compgen -G "$path*" >/dev/null || fault "$page: there is no '$path'"
  done < <(prose "$page" | grep -oE '`(docs|examples|grammar|modeler|pipeline|viewer|cli|tests|cmake|integrations)/[A-Za-z0-9_./-]+`' | tr -d '`' | sort -u)
done < <(find . -maxdepth 1 -name '*.md'; find docs integrations -name '*.md' -not -path '*/node_modules/*' 2>/dev/null)

while read -r page; do
  grep -qF "(${page#docs/})" docs/README.md || fault "docs/README.md doesn't list $page"
done < <(find docs -name '*.md' -not -name README.md)

while read -r example; do
  grep -qF "(../$example)" docs/examples.md || fault "docs/examples.md doesn't list $example"
done < <(find examples -name '*.sgm' -o -name '*.cpp' -path 'examples/*')

while read -r picture; do
  grep -rqF "$(basename "$picture")" --include='*.md' . || fault "no page shows $picture"
done < <(find docs/pictures -type f)
room=$(find docs -name '*.jpg' -printf '%s\n' -o -name '*.png' -printf '%s\n' | awk '{ sum += $1 } END { print sum }')
[ "$room" -le $((4 << 20)) ] || fault "pictures take $room bytes, more than 4 MiB"
lines=$(wc -l <docs/performance.md)
[ "$lines" -le 100 ] || fault "docs/performance.md has $lines lines, more than 100"

[ $faults -eq 0 ]
