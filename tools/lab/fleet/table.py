"""A table as a file, and as a page with maps."""
import csv
import html


def write_table(path, rows):
    if path.suffix == ".parquet":
        import pyarrow
        from pyarrow import parquet
        parquet.write_table(pyarrow.Table.from_pylist(rows), path)
        return
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def write_page(folder, rows, pictures):
    folder.mkdir(parents=True, exist_ok=True)
    cells = []
    for number, (row, picture) in enumerate(zip(rows, pictures)):
        if picture:
            (folder / f"{number}.png").write_bytes(picture)
        image = f'<img src="{number}.png" width="300">' if picture else ""
        cells.append("<tr><td>" + "</td><td>".join([image, *(html.escape(str(value)) for value in row.values())]) + "</td></tr>")
    head = "<tr><th>map</th>" + "".join(f"<th>{html.escape(name)}</th>" for name in rows[0]) + "</tr>"
    (folder / "index.html").write_text(f"<!doctype html><meta charset=utf-8><title>ale-fleet</title><table>\n{head}\n" + "\n".join(cells)
                                       + "\n</table>\n", encoding="utf-8")
