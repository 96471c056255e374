# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""index.html: a picture of each item, the worst first."""
import html
import os
import urllib.parse

from pcl_cosection_batch.measures import badness, number
from pcl_cosection_batch.store import COMPLETE, Record, Store, write_atomically
from pcl_cosection_batch.tables import counts
from pcl_cosection_batch.terminal import counted, duration_text

MOST_REMARKS = 5
STATUS_ORDER = ("failed", "partial", "missing", "outdated", "done")
STATUS_WORDS = {"failed": "failed", "partial": "some objects failed", "missing": "not done yet",
                "outdated": "of older inputs", "done": "done"}
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 1320px; padding: 24px;
  color: #222; background: #f4f5f7 }
h1 { font-size: 22px; margin: 0 0 4px } h1 + p { margin: 0 0 4px; color: #555 } .key { color: #555; margin: 4px 0 20px }
.key i { display: inline-block; width: 11px; height: 11px; border-radius: 2px; margin: 0 5px 0 12px }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(400px, 1fr)); gap: 16px }
article { background: #fff; border: 1px solid #dcdfe3; border-radius: 8px; overflow: hidden;
  border-top: 4px solid #8fbc8f }
article.failed { border-top-color: #c0392b } article.partial { border-top-color: #e08e2b }
article.missing, article.outdated { border-top-color: #999 }
figure { display: flex; margin: 0; background: #f6f7f9 } figure a { flex: 1 }
article img { display: block; width: 100%; aspect-ratio: 400 / 340; object-fit: contain }
article div { padding: 10px 14px 12px } h2 { font-size: 16px; margin: 0; overflow-wrap: anywhere }
h2 a { color: inherit } .status { float: right; font-size: 13px; margin-left: 10px; color: #555 }
.failed .status { color: #c0392b } .partial .status { color: #b36b12 }
p { margin: 6px 0 0; overflow-wrap: anywhere } .reason { color: #a02a1e } .numbers { color: #555; font-size: 13px }
ul { margin: 6px 0 0; padding-left: 18px; font-size: 13px; color: #8a5a00; overflow-wrap: anywhere }
"""


def escaped(text: object) -> str:
    """Text for HTML. Bytes of names that are no UTF-8 become question marks."""
    plain = str(text).encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    return html.escape("".join(c if c.isprintable() or c == " " else "\N{REPLACEMENT CHARACTER}" for c in plain))


def link(*parts: str) -> str:
    """A relative address."""
    return html.escape("/".join(urllib.parse.quote(os.fsencode(part), safe="") for part in parts))


def numbers_of(record: Record) -> str:
    """The measures of an item, in one line."""
    parts = []
    if record.get("objects"):
        parts.append(counted(int(record["objects"]), "object"))
    for name, text in (("relative_error", "expected error {:.1%} of the size"), ("guessed_share", "{:.0%} guessed"),
                       ("contradicted_share", "{:.1%} contradicted")):
        value = number(record, name)
        if value:
            parts.append(text.format(value))
    penetration = number(record, "penetration_m")
    if penetration:
        parts.append(f"{1000 * penetration:.1f} mm inside another body")
    if record.get("seconds"):
        parts.append(duration_text(float(record["seconds"])))
    if record.get("peak_memory_bytes"):
        parts.append(f"{record['peak_memory_bytes'] / 2**20:.0f} MiB")
    if int(record.get("attempts") or 1) > 1:
        parts.append(f"{record['attempts']} attempts")
    return ", ".join(parts)


def card(store: Store, record: Record) -> str:
    """The part of the page about one item."""
    name, status = str(record["name"]), str(record["status"])
    has_result = status in COMPLETE or status == "outdated"
    title = f'<a href="{link(name)}/">{escaped(name)}</a>' if has_result else escaped(name)
    lines = [f'<article class="{escaped(status)}">']
    pictures = [picture for picture in record.get("pictures") or []
                if has_result and os.path.isfile(os.path.join(store.result(name), picture))]
    if pictures:
        sides = ("from the side of the sensor", "from behind")
        lines.append("<figure>" + "".join(
            f'<a href="{link(name, picture)}"><img src="{link(name, picture)}" alt="{escaped(name)} {side}" '
            f'loading="lazy"></a>' for picture, side in zip(pictures, sides)) + "</figure>")
    lines.append(f'<div><span class="status">{escaped(STATUS_WORDS.get(status, status))}</span><h2>{title}</h2>')
    if record.get("reason"):
        lines.append(f'<p class="reason">{escaped(record["reason"])}</p>')
    remarks = [*(record.get("warnings") or []), *(record.get("notes") or [])]
    if remarks:
        more = len(remarks) - MOST_REMARKS
        shown = [escaped(text) for text in remarks[:MOST_REMARKS]] + ([f"and {more} more"] if more > 0 else [])
        lines.append("<ul>" + "".join(f"<li>{text}</li>" for text in shown) + "</ul>")
    log = (name, "log.txt") if has_result else (".batch", "failed", name, "log.txt")
    links = f' · <a href="{link(*log)}">log</a>' if os.path.isfile(os.path.join(store.output, *log)) else ""
    lines.append(f'<p class="numbers">{escaped(numbers_of(record))}{links}</p></div></article>')
    return "\n".join(lines)


def page(store: Store, records: list[Record], written: str) -> str:
    """The whole page."""
    number_of = counts(records)
    summary = ", ".join(f"{number_of[status]} {STATUS_WORDS[status]}" for status in STATUS_ORDER if status in number_of)
    worst_first = sorted(records, key=badness, reverse=True)
    cards = "\n".join(card(store, record) for record in worst_first)
    title = escaped(os.path.basename(store.output) or "batch")
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="script-src 'none'; object-src 'none'; base-uri 'none'">
<title>{title}: {escaped(summary)}</title>
<style>{STYLE}</style>
</head>
<body>
<h1>{title}</h1>
<p>{counted(len(records), "item")}: {escaped(summary)}. The worst come first: what failed, then by the
number of warnings, then by the expected error relative to the object's size. <a href="summary.csv">summary.csv</a> has
all numbers. Written {escaped(written[:16].replace("T", " "))} UTC.</p>
<p class="key">Left from the side of the sensor, right from behind:<i style="background:#bebebe"></i>observed<i
style="background:#f09632"></i>inferred<i
style="background:#5082dc"></i>bounded by free space<i style="background:#5ab45a"></i>bounded by another body</p>
<main>
{cards}
</main>
</body>
</html>
"""


def write_overview(store: Store, records: list[Record], written: str) -> None:
    """Writes index.html."""
    write_atomically(store.result("index.html"), page(store, records, written).encode("utf-8", "replace"))
