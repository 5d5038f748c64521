# Writes the grammar as it stands after a step of docs/tutorial.md:
#   awk -v step=4 -f docs/tutorial.awk docs/tutorial.md >tower.sgm
# A block of grammar adds its declarations to those of the steps before it, or replaces those of the same name (of rules, all of
# the same symbol). Comments belong to the declaration below them; lines that begin with a blank go on with the one above.
/^## Step / { reached = $3 + 0 }
/^```sgm$/ { inside = 1; block++; comment = ""; next }
/^```/ { inside = 0; next }
!inside || reached > step || !NF { next }
/^\/\// { comment = comment $0 "\n"; next }
/^ / { text[key] = text[key] $0 "\n"; next }
{
  key = $1 " " $2
  if (!(key in since)) order[++count] = key
  if (since[key] != block) text[key] = ""
  since[key] = block
  text[key] = text[key] comment $0 "\n"
  comment = ""
}
END {
  kinds = split("grammar use param terminal start rule", kind)
  for (k = 1; k <= kinds; k++) {
    if (k == 3 || k == 4 || k == 5) printf "%s", gap
    gap = ""
    for (i = 1; i <= count; i++)
      if (index(order[i], kind[k] " ") == 1) { printf "%s", text[order[i]]; gap = "\n" }
  }
}
