# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Charts as SVG, written by hand: a logarithmic line chart and a chart of bars. Same data, same bytes."""

import math
from dataclasses import dataclass
from html import escape

WIDTH, HEIGHT = 860, 520
LEFT, RIGHT, TOP, BOTTOM = 78, 250, 52, 58
PLOT_WIDTH, PLOT_HEIGHT = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
INK, GRID = "#222222", "#dddddd"


@dataclass(frozen=True)
class Series:
    label: str
    color: str
    points: list[tuple[float, float]]
    dashed: bool = False
    heavy: bool = False


def _text(x: float, y: float, text: str, anchor: str = "start", size: int = 13, color: str = INK,
          extra: str = "") -> str:
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{color}"{extra}>'
            f"{escape(text)}</text>")


def _line(x1: float, y1: float, x2: float, y2: float, color: str, width: float = 1) -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{color}" stroke-width="{width}"/>'


def _document(title: str, subtitle: str, body: list[str], height: int = HEIGHT) -> str:
    head = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            f'font-family="sans-serif" role="img" aria-label="{escape(title)}">',
            f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
            _text(LEFT, 24, title, size=16, extra=' font-weight="bold"'),
            _text(LEFT, 42, subtitle, size=12, color="#555555")]
    return "\n".join(head + body + ["</svg>", ""])


class _LogAxis:
    """Whole decades around the values."""

    def __init__(self, values: list[float], start: float, length: float):
        self.first = math.floor(math.log10(min(values)) + 1e-9)
        self.last = max(math.ceil(math.log10(max(values)) - 1e-9), self.first + 1)
        self.start, self.length = start, length

    def place(self, value: float) -> float:
        return self.start + self.length * (math.log10(value) - self.first) / (self.last - self.first)

    def decades(self) -> list[float]:
        return [10.0 ** power for power in range(self.first, self.last + 1)]

    def steps(self) -> list[float]:
        return [digit * decade for decade in self.decades()[:-1] for digit in range(2, 10)]


def log_log(title: str, subtitle: str, x_title: str, y_title: str, series: list[Series], x_label, y_label) -> str:
    """A line a series over two logarithmic axes; `x_label` and `y_label` write the decades."""
    series = [one for one in series if one.points]
    x = _LogAxis([point[0] for one in series for point in one.points], LEFT, PLOT_WIDTH)
    y = _LogAxis([point[1] for one in series for point in one.points], TOP + PLOT_HEIGHT, -PLOT_HEIGHT)
    body = []
    for value in x.steps():
        body.append(_line(x.place(value), TOP + PLOT_HEIGHT, x.place(value), TOP + PLOT_HEIGHT + 4, GRID))
    for value in y.steps():
        body.append(_line(LEFT - 4, y.place(value), LEFT, y.place(value), GRID))
    for value in x.decades():
        body.append(_line(x.place(value), TOP, x.place(value), TOP + PLOT_HEIGHT, GRID))
        body.append(_text(x.place(value), TOP + PLOT_HEIGHT + 20, x_label(value), "middle"))
    for value in y.decades():
        body.append(_line(LEFT, y.place(value), LEFT + PLOT_WIDTH, y.place(value), GRID))
        body.append(_text(LEFT - 8, y.place(value) + 4, y_label(value), "end"))
    body.append(_text(LEFT + PLOT_WIDTH / 2, HEIGHT - 14, x_title, "middle"))
    body.append(_text(18, TOP + PLOT_HEIGHT / 2, y_title, "middle",
                      extra=f' transform="rotate(-90 18 {TOP + PLOT_HEIGHT / 2:.1f})"'))
    for one in series:
        places = [(x.place(a), y.place(b)) for a, b in sorted(one.points)]
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
        dash = ' stroke-dasharray="6 4"' if one.dashed else ""
        body.append(f'<polyline points="{path}" fill="none" stroke="{one.color}" '
                    f'stroke-width="{3 if one.heavy else 1.8}"{dash}/>')
        radius = 4 if one.heavy else 3
        body += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{radius}" fill="{one.color}"/>' for a, b in places]
    rightmost = max(point[0] for one in series for point in one.points)
    short = [one for one in series if max(one.points)[0] < rightmost]
    for one in short:
        a, b = max(one.points)
        body.append(_text(x.place(a), y.place(b) - 10, one.label, "end", color=one.color, size=12))
    body += _labels_at_the_end([one for one in series if one not in short], y)
    return _document(title, subtitle, body)


def _labels_at_the_end(series: list[Series], y: _LogAxis) -> list[str]:
    """Each label beside the last point of its line, pushed apart where they would overlap."""
    wanted = sorted(((y.place(max(one.points)[1]), one) for one in series), key=lambda pair: pair[0])
    heights, last = [], TOP - 6.0
    for place, _ in wanted:
        last = max(place + 4, last + 16)
        heights.append(last)
    surplus = max(0.0, heights[-1] - (TOP + PLOT_HEIGHT + 4))
    return [_text(LEFT + PLOT_WIDTH + 14, height - surplus, one.label, color=one.color, size=12,
                  extra=' font-weight="bold"' if one.heavy else "")
            for height, (_, one) in zip(heights, wanted)]


@dataclass(frozen=True)
class Bar:
    group: str
    label: str
    value: float
    color: str


def bars(title: str, subtitle: str, bars_: list[Bar], unit: str) -> str:
    """Horizontal bars in groups, the value at the end of each."""
    row, gap, left = 20, 14, 300
    height = TOP + 24 + sum(row + (gap + 18 if new else 0) for _, new in _with_breaks(bars_))
    scale = (WIDTH - left - 90) / max(bar.value for bar in bars_)
    body, y = [], float(TOP)
    for bar, new in _with_breaks(bars_):
        if new:
            y += gap
            body.append(_text(20, y + 12, bar.group, size=13, extra=' font-weight="bold"'))
            y += 18
        body.append(_text(left - 8, y + 14, bar.label, "end", size=12))
        body.append(f'<rect x="{left}" y="{y + 2:.1f}" width="{max(1.0, bar.value * scale):.1f}" height="{row - 4}" '
                    f'fill="{bar.color}"/>')
        body.append(_text(left + bar.value * scale + 6, y + 14, f"{bar.value:.3g} {unit}", size=12))
        y += row
    return _document(title, subtitle, body, height)


def _with_breaks(bars_: list[Bar]) -> list[tuple[Bar, bool]]:
    return [(bar, index == 0 or bars_[index - 1].group != bar.group) for index, bar in enumerate(bars_)]
