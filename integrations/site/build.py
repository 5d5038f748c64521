#!/usr/bin/python3
"""Makes the site: the pages of docs/ in the order of docs/README.md, the examples and the standard library as pages, and a
search over all of them.  integrations/site/build.py [FOLDER]     (out/site; wants mkdocs)"""
import html.parser
import json
import logging
import os
import posixpath
import re
import shutil
import sys
import tempfile

try:
    import pygments.lexer
    import pygments.lexers
    import pygments.token
    import pygments.util
    from mkdocs.commands.build import build
    from mkdocs.config import load_config
except ImportError:
    sys.exit("mkdocs isn't installed (apt-get install mkdocs)")

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SOURCES = {".sgm": "sgm", ".cpp": "cpp", ".py": "python"}
LINK = re.compile(r"(\]\()([^)\s]+)(\))")


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def slug(text, separator="-"):
    """A heading's anchor as GitHub makes it, which links in the pages count on."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", separator)


def lexer_class():
    """Pygments' lexer for grammars, from the TextMate grammar that the parser's tables make."""
    kinds = {"comment": "Comment.Single", "string": "String", "constant.numeric": "Number", "constant": "Literal",
             "keyword.operator": "Operator", "keyword": "Keyword", "storage": "Name.Function",
             "support.function": "Name.Builtin", "support.type": "Keyword.Type", "variable.language": "Name.Constant",
             "entity": "Name.Class", "variable": "Name"}

    def token(name):
        kind = next((kinds[start] for start in kinds if name.startswith(start)), "Text")
        return pygments.token.string_to_tokentype(kind)

    grammar = json.loads(read("integrations/vscode/syntaxes/sgm.tmLanguage.json"))
    rules = [(entry["match"], token(entry["name"])) for entry in grammar["patterns"]]
    rules += [(r"\s+", pygments.token.Whitespace), (r".", pygments.token.Text)]
    members = {"name": "sgm", "aliases": ["sgm"], "flags": re.MULTILINE, "tokens": {"root": rules}}
    return type("SgmLexer", (pygments.lexer.RegexLexer,), members)


def teach_pygments():
    """Lets ```sgm blocks be coloured."""
    lexer, known = lexer_class(), pygments.lexers.get_lexer_by_name

    def by_name(name, **options):
        return lexer(**options) if name == "sgm" else known(name, **options)

    pygments.lexers.get_lexer_by_name = by_name
    import markdown.extensions.codehilite as codehilite
    codehilite.get_lexer_by_name = by_name


def sources():
    """Files that have a page of their own, by their paths in the repository."""
    found = []
    for top in ("examples", "grammar/std"):
        for folder, _, names in os.walk(os.path.join(ROOT, top)):
            found += [os.path.relpath(os.path.join(folder, name), ROOT) for name in names]
    return sorted(path for path in found if os.path.splitext(path)[1] in SOURCES)


def page_of(path):
    """Where a file of the repository is in the site's pages; None where it isn't."""
    if path in ("README.md", "docs/README.md"):
        return "index.md" if path == "README.md" else "pages.md"
    if path.startswith("docs/") and (path.endswith(".md") or path.startswith("docs/pictures/")):
        return path[len("docs/"):]
    if path in ("CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"):
        return path
    if path in PAGES:
        return path + ".md"
    return None


def relinked(text, path):
    """The text of a page with its links as they are in the site; those to other files become code."""
    here = page_of(path)

    def one(match):
        target, _, anchor = match[2].partition("#")
        if not target or "://" in target:
            return match[0]
        wanted = posixpath.normpath(posixpath.join(posixpath.dirname(path), target))
        wanted = {"docs": "docs/README.md", "LICENSE": ""}.get(wanted, wanted)
        page = page_of(wanted)
        if page is None:
            return "](https://sgm.invalid/" + wanted + ")"
        link = posixpath.relpath(page, posixpath.dirname(here) or ".")
        return match[1] + link + ("#" + anchor if anchor else "") + match[3]

    parts = re.split(r"(^```.*?^```\s*?$)", text, flags=re.MULTILINE | re.DOTALL)
    parts[::2] = [LINK.sub(one, part) for part in parts[::2]]
    text = "".join(parts)
    return re.sub(r"\[([^\]]*)\]\(https://sgm\.invalid/[^)]*\)", r"\1", text)  # files that the site leaves out


def spaced(text):
    """Blank lines before lists and tables, which Python's Markdown wants and GitHub's doesn't."""
    lines, code = [], False
    for line in text.split("\n"):
        if line.startswith("```"):
            code = not code
        begins = re.match(r"(#+ |- |\* |\d+\. |\|)", line)
        before = lines[-1] if lines else ""
        if not code and begins and before.strip() and (line[0] == "#" or not re.match(r"(\s|- |\* |\d+\. |\||<)", before)):
            lines.append("")
        lines.append(line)
    return "\n".join(lines)


def write(folder, page, text):
    path = os.path.join(folder, page)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def stage(folder):
    """Writes the pages as mkdocs reads them."""
    for at, _, names in os.walk(os.path.join(ROOT, "docs")):
        for name in names:
            path = os.path.relpath(os.path.join(at, name), ROOT)
            if name.endswith(".md"):
                write(folder, page_of(path), spaced(relinked(read(path), path)))
            elif path.startswith("docs/pictures/"):
                os.makedirs(os.path.join(folder, os.path.dirname(page_of(path))), exist_ok=True)
                shutil.copy(os.path.join(ROOT, path), os.path.join(folder, page_of(path)))
    for path in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"):
        write(folder, page_of(path), spaced(relinked(read(path), path)))
    for path in PAGES:
        text = read(path).rstrip("\n")
        write(folder, page_of(path), f"# {os.path.basename(path)}\n\n`{path}`\n\n```{SOURCES[os.path.splitext(path)[1]]}\n{text}\n```\n")
    shutil.copy(os.path.join(HERE, "site.css"), folder)
    shutil.copy(os.path.join(ROOT, "integrations", "desktop", "sgm.svg"), folder)


def navigation():
    """The pages by the sections of docs/README.md, then the sources."""
    sections = [{"Overview": "index.md"}, {"All pages": "pages.md"}]
    for line in read("docs/README.md").splitlines():
        heading = re.match(r"\| ([a-z ]+) \| \|", line)
        if heading:
            sections.append({heading[1].capitalize(): []})
        elif line.startswith("| ["):
            pages = re.findall(r"\[([^\]]+)\]\(([^)#]+\.md)\)", line.split(" | ")[0])
            next(iter(sections[-1].values())).extend({title[0].upper() + title[1:]: page} for title, page in pages)
    sections.append({"Sources": [{path: page_of(path)} for path in PAGES]})
    sections.append({"The project": [{"Changes": "CHANGELOG.md"}, {"Contributing": "CONTRIBUTING.md"}, {"Strangers' grammars": "SECURITY.md"}]})
    return sections


def complete_theme(target):
    """Debian's theme names scripts that it doesn't ship: jQuery by another version's number, and two that pages do without."""
    scripts = os.path.join(target, "js")
    jquery = sorted(name for name in os.listdir(scripts) if name.startswith("jquery-"))[-1]

    def one(match):
        name = os.path.basename(match[1])
        if name.startswith("jquery-") and name != jquery:
            shutil.copy(os.path.join(scripts, jquery), os.path.join(scripts, name))
        return match[0] if os.path.exists(os.path.join(scripts, name)) else ""

    for at, _, names in os.walk(target):
        for name in (name for name in names if name.endswith(".html")):
            with open(os.path.join(at, name), "r+", encoding="utf-8") as file:
                text = re.sub(r'<script src="[./]*(js/[\w.-]+)"[^>]*></script>', one, file.read())
                file.seek(0)
                file.write(text)
                file.truncate()


class Problems(logging.Handler):
    """Counts what mkdocs warns of, as links that lead nowhere."""

    def __init__(self):
        super().__init__(logging.WARNING)
        self.count = 0

    def emit(self, record):
        self.count += 1
        print(record.getMessage(), file=sys.stderr)


class Anchors(html.parser.HTMLParser):
    """The names that links may lead to in a page, and the links of its text."""

    def __init__(self):
        super().__init__()
        self.names, self.links = set(), []

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.names.add(value)
            elif name == "href" and tag == "a" and value:
                self.links.append(value)


def dead_links(target):
    """Links within the site that lead to no page or no heading."""
    pages = {}
    for at, _, names in os.walk(target):
        for name in names:
            path = os.path.relpath(os.path.join(at, name), target)
            pages[path] = None
            if name.endswith(".html"):
                pages[path] = Anchors()
                with open(os.path.join(at, name), encoding="utf-8") as file:
                    pages[path].feed(file.read())
    for path, anchors in sorted(pages.items()):
        for link in anchors.links if anchors and path != "404.html" else ():
            file, _, name = link.partition("#")
            if "://" in link or link.startswith(("mailto:", "javascript:")) or link in (".", ".."):
                continue
            wanted = posixpath.normpath(posixpath.join(posixpath.dirname(path), file)) if file else path
            if wanted not in pages or (name and pages[wanted] and name not in pages[wanted].names):
                yield f"{path}: '{link}' leads nowhere"


def main(target):
    problems = Problems()
    logging.getLogger("mkdocs").addHandler(problems)
    teach_pygments()
    with tempfile.TemporaryDirectory() as folder:
        pages = os.path.join(folder, "pages")
        stage(pages)
        settings = {
            "site_name": "sgm", "docs_dir": pages, "site_dir": target, "nav": navigation(), "extra_css": ["site.css"],
            "theme": {"name": "readthedocs", "highlightjs": False, "navigation_depth": 2, "collapse_navigation": False,
                      "titles_only": True},
            "markdown_extensions": ["tables", "fenced_code", "sane_lists", "codehilite", "toc"],
            "use_directory_urls": False,
        }
        with open(os.path.join(folder, "mkdocs.yml"), "w", encoding="utf-8") as file:
            json.dump(settings, file)
        config = load_config(os.path.join(folder, "mkdocs.yml"))
        config["mdx_configs"]["toc"] = {"slugify": slug, "permalink": False}
        config["mdx_configs"]["codehilite"] = {"guess_lang": False}
        build(config)
    complete_theme(target)
    dead = list(dead_links(target))
    if problems.count or dead:
        sys.exit("\n".join(dead) + f"\n{problems.count + len(dead)} problems")
    print(os.path.join(target, "index.html"))



PAGES = sources()

if __name__ == "__main__":
    main(os.path.realpath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "out", "site")))
