"""Panels put together: one PNG, or one HTML page that needs nothing beside it."""
import html
import io

import matplotlib.pyplot as plt

from .runs import Trouble

STYLE = """body{font:16px/1.5 sans-serif;margin:2rem auto;max-width:70rem;padding:0 1rem;color:#222;background:#fff}
table{border-collapse:collapse;margin:1rem 0}td,th{padding:.3rem .7rem;border-bottom:1px solid #ccc;text-align:right}
td:first-child,th:first-child{text-align:left}figure{margin:2rem 0}svg{max-width:100%;height:auto}"""


def write(path, panels, rows, title):
    if path.endswith(".png"):
        _write_png(path, panels, title)
    else:
        _write_html(path, panels, rows, title)


def _write_png(path, panels, title):
    drawn = [panel for panel in panels if panel[0] != "table"]
    table = [panel for panel in panels if panel[0] == "table"]
    rows = (len(drawn) + 1) // 2
    figure = plt.figure(figsize=(14, 5.2 * rows + (1.6 if table else 0)), layout="constrained")
    grid = figure.add_gridspec(rows + len(table), 2, height_ratios=[5.2] * rows + [1.2] * len(table))
    for k, (_, draw) in enumerate(drawn):
        last_alone = k == len(drawn) - 1 and k % 2 == 0
        draw(figure.add_subplot(grid[k // 2, :] if last_alone else grid[k // 2, k % 2]))
    for _, draw in table:
        draw(figure.add_subplot(grid[rows, :]))
    figure.suptitle(title)
    _save(figure, path, dpi=110)


def _svg(draw):
    figure, axes = plt.subplots(figsize=(10, 5.5), layout="constrained")
    draw(axes)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    return text.getvalue().partition("<svg")[1] + text.getvalue().partition("<svg")[2]


def _write_html(path, panels, rows, title):
    plt.rcParams["svg.hashsalt"] = "ale-plot"
    cells = ["<tr>" + "".join(f"<{tag}>{html.escape(word)}</{tag}>" for word in row) + "</tr>"
             for tag, row in [("th", rows[0]), *(("td", row) for row in rows[1:])]]
    figures = [f'<figure id="{name}" role="img" aria-label="{name}">{_svg(draw)}</figure>' for name, draw in panels if name != "table"]
    page = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{STYLE}</style></head>\n'
            f"<body><h1>{html.escape(title)}</h1>\n<table>{''.join(cells)}</table>\n" + "\n".join(figures) + "\n</body></html>\n")
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
    except OSError as error:
        raise Trouble(f"{path}: {error.strerror}") from error


def _save(figure, path, **how):
    try:
        figure.savefig(path, **how)
    except OSError as error:
        raise Trouble(f"{path}: {error.strerror}") from error
    plt.close(figure)
