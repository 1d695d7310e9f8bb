# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders docs/qgis.md as the page that the Help button of QGIS opens, with its pictures.
Usage: manual.py OUTPUT_DIR; pack.py puts the same files into the plugin."""
import html
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/qgis.md"
HEAD = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>thalweg in QGIS</title><style>
body { max-width: 60em; margin: 1em auto; padding: 0 1em; font: 16px/1.5 sans-serif; color: #222; background: #fff }
table { border-collapse: collapse } td, th { border: 1px solid #ccc; padding: .3em .6em; text-align: left; vertical-align: top }
code, pre { font: 14px/1.4 monospace; background: #f3f3f3 } pre { padding: .6em; overflow-x: auto } img { max-width: 100% }
</style></head><body>
"""


def inline(text):
    """A line of text; links lead to pictures and pages of the web alone, for the plugin has no other pages."""
    codes = []

    def kept(found):
        codes.append(f"<code>{html.escape(found[1], quote=False)}</code>")
        return f"\0{len(codes) - 1}\0"

    text = html.escape(re.sub(r"`([^`]+)`", kept, text), quote=False)
    text = re.sub(r"!\[([^\]]*)\]\(([^)]+)\)", r'<img src="\2" alt="\1">', text)
    text = re.sub(r"\[([^\]]+)\]\((https?://[^)]+|#[^)]+)\)", r'<a href="\2">\1</a>', text)
    text = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
    text = re.sub(r"\*([^*]+)\*", r"<i>\1</i>", text)
    return re.sub("\0(\\d+)\0", lambda found: codes[int(found[1])], text)


def table(lines):
    """Rows of cells between bars; the second line is a rule."""
    rows = [[inline(cell.strip()) for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))] for line in lines]
    head = "".join(f"<th>{cell}</th>" for cell in rows[0])
    body = "\n".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows[2:])
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def blocks(text):
    """Parts between empty lines; code and lists are one part each."""
    found, lines = [], text.splitlines()
    while lines:
        if not lines[0].strip():
            lines.pop(0)
            continue
        part = [lines.pop(0)]
        if part[0].startswith("```"):
            while not lines[0].startswith("```"):
                part.append(lines.pop(0))
            lines.pop(0)
        else:
            is_list = re.match(r"(\d+\.|\*) ", part[0])
            while lines and (lines[0].strip() or (is_list and len(lines) > 1 and lines[1].startswith("  "))):
                if is_list is None and re.match(r"(#+ |```)", lines[0]):
                    break
                part.append(lines.pop(0))
        found.append(part)
    return found


def items(lines):
    """The items of a list, each without its mark and indent."""
    found = []
    for line in lines:
        if mark := re.match(r"(\d+\.|\*) +", line):
            found.append([line[mark.end():]])
        else:
            found[-1].append(line.strip())
    return ["\n".join(item) for item in found]


def rendered(text):
    """Markdown, as far as docs/qgis.md uses it, as HTML."""
    out = []
    for part in blocks(text):
        if part[0].startswith("```"):
            out.append(f"<pre>{html.escape(chr(10).join(part[1:]), quote=False)}</pre>")
        elif heading := re.match(r"(#+) (.*)", part[0]):
            level, title = len(heading[1]), heading[2]
            name = re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")
            out.append(f'<h{level} id="{name}">{inline(title)}</h{level}>')
            out.append(rendered("\n".join(part[1:])))
        elif part[0].startswith("|"):
            out.append(table(part))
        elif re.match(r"(\d+\.|\*) ", part[0]):
            kind = "ol" if part[0][0].isdigit() else "ul"
            out.append(f"<{kind}>\n" + "\n".join(f"<li>{rendered(item)}</li>" for item in items(part)) + f"\n</{kind}>")
        else:
            out.append(f"<p>{inline(' '.join(part))}</p>")
    return "\n".join(filter(None, out))


def files():
    """The page and its pictures, by their names in the folder help of the plugin."""
    text = PAGE.read_text("utf-8")
    pictures = sorted(set(re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)))
    page = f"{HEAD}{rendered(text)}\n</body></html>\n"
    return {"index.html": page.encode(), **{name: (PAGE.parent / name).read_bytes() for name in pictures}}


if __name__ == "__main__":
    for name, content in files().items():
        path = pathlib.Path(sys.argv[1]) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
