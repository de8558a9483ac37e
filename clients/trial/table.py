"""Tables for the terminal."""


def aligned(head: list[str], rows: list[list[str]]) -> str:
    """A table with a line under its head."""
    widths = [max(len(row[place]) for row in [head, *rows]) for place in range(len(head))]
    line = lambda cells: "  ".join(cell.ljust(width) for cell, width in zip(cells, widths)).rstrip()
    return "\n".join([line(head), "─" * (sum(widths) + 2 * len(widths) - 2), *map(line, rows)])


def markdown(head: list[str], rows: list[list[str]]) -> str:
    """The same as Markdown, numbers to the right."""
    cells = lambda row: "| " + " | ".join(row) + " |"
    return "\n".join([cells(head), "|---|" + "--:|" * (len(head) - 1), *map(cells, rows)])
