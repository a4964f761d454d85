// Draws the line pictures of the page again on a canvas, with zoom and a cursor. Without this
// script, on paper, or where anything here fails, the drawings that are already in the page stay.
"use strict";
(function () {
  const STEPS_GAP = 65535;
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const plots = [];

  function bytes(text) {
    const raw = atob(text);
    const out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return new DataView(out.buffer);
  }

  function abscissa(x) {
    const view = bytes(x.data);
    const out = [];
    for (let i = 0; i < view.byteLength; i += 4) {
      out.push(onAxis(x.from + (view.getUint32(i, true) / 4294967295) * (x.to - x.from), x.log));
    }
    return out;
  }

  // Values of a logarithmic axis come as their logarithms.
  function ordinate(series) {
    const view = bytes(series.data);
    const out = [];
    for (let i = 0; i < view.byteLength; i += 2) {
      const step = view.getUint16(i, true);
      const value = series.from + step * series.step;
      out.push(step === STEPS_GAP ? null : value);
    }
    return out;
  }

  const MINUS = "\u2212";
  const SUPERSCRIPT = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074",
    5: "\u2075", 6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079" };
  function written(value) {
    if (value == null || !isFinite(value)) return "";
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
      const [digits, power] = value.toExponential(3).split("e");
      const raised = String(Number(power)).split("").map((c) => SUPERSCRIPT[c]).join("");
      return digits.replace("-", MINUS) + "\u00b710" + raised;
    }
    return String(Number(value.toPrecision(5))).replace("-", MINUS);
  }
  // With a power of ten throughout where the axis has one, as in the drawings.
  function tick(value, powers) {
    const power = Math.log10(Math.abs(value));
    if (value !== 0 && (powers || power < -3 || power >= 6)) {
      const whole = Math.floor(power + 1e-9);
      const digit = Math.round(value / Math.pow(10, whole));
      const raised = String(whole).split("").map((c) => SUPERSCRIPT[c]).join("");
      return (digit === 1 ? "" : String(digit).replace("-", MINUS) + "\u00b7") + "10" + raised;
    }
    return String(Number(value.toPrecision(10))).replace("-", MINUS);
  }

  // On a logarithmic axis everything is plotted over the logarithm: the axis stays linear.
  const onAxis = (value, log) => (log ? Math.log10(value) : value);
  const offAxis = (value, log) => (log && value != null ? Math.pow(10, value) : value);

  // Ends of the ordinate around what is shown, with a little room.
  function around(low, high, log) {
    if (low == null || high == null) return [0, 1];
    if (log) low = Math.max(low, high - 12);
    const span = high - low || (log ? 1 : 0.2 * Math.abs(high) || 2);
    return [low - 0.05 * span, high + 0.05 * span];
  }

  // Logarithms of 1, 2 and 5 times powers of ten, as dense as they can be read.
  function decades(low, high, room) {
    const out = [];
    const most = Math.max(3, room);
    const stride = Math.max(1, Math.ceil((high - low) / most));
    const digits = 3 * (high - low) <= most ? [1, 2, 5] : [1];
    for (let power = Math.floor(low); power <= high; power++) {
      if (power % stride !== 0) continue;
      for (const digit of digits) {
        const at = power + Math.log10(digit);
        if (at >= low && at <= high) out.push(at);
      }
    }
    return out;
  }

  function clipped(context, text, limit) {
    if (context.measureText(text).width <= limit) return text;
    while (text.length > 1 && context.measureText(text + "\u2026").width > limit) text = text.slice(0, -1);
    return text.trim() + "\u2026";
  }

  // Stretches with a name, behind the data; names that would collide are left out.
  function spans(list, log) {
    return (u) => {
      const context = u.ctx;
      const ratio = window.devicePixelRatio || 1;
      const { left, top, width, height } = u.bbox;
      const rows = [[], []];
      context.save();
      context.font = 12 * ratio + "px system-ui, sans-serif";
      context.textAlign = "center";
      for (const span of list) {
        const x = u.scales.x;
        const low = log && span.from <= 0 ? x.min : onAxis(span.from, log);
        const high = onAxis(span.to, log);
        if (x.min == null || !(high >= x.min && low <= x.max)) continue;
        const at = (v) => u.valToPos(Math.min(Math.max(v, x.min), x.max), "x", true);
        const from = at(low);
        const to = Math.max(at(high), from + 2 * ratio);
        context.fillStyle = css("--shade");
        context.fillRect(from, top, to - from, height);
        const text = clipped(context, span.label, 0.95 * width);
        const half = 0.5 * context.measureText(text).width;
        const centre = Math.min(Math.max(0.5 * (from + to), left + half), left + width - half);
        const row = rows.findIndex((r) => r.every(([a, b]) => centre + half < a || centre - half > b));
        if (row < 0 || !text) continue;
        rows[row].push([centre - half - 8 * ratio, centre + half + 8 * ratio]);
        context.fillStyle = css("--soft");
        context.fillText(text, centre, top - (7 + 15 * row) * ratio);
      }
      context.restore();
    };
  }

  function axis(label, log, side) {
    const font = "12px system-ui, sans-serif";
    const size = (u, values) => {
      const widest = (values || []).reduce((w, v) => Math.max(w, v ? v.length : 0), 0);
      return 14 + 7 * widest;
    };
    const extra = log ? { splits: (u, i, low, high) => decades(low, high, side === "y" ? 7 : u.width / 70) } : {};
    return {
      ...extra,
      scale: side,
      label: label,
      labelSize: 22,
      labelGap: 2,
      labelFont: "13px system-ui, sans-serif",
      font: font,
      size: side === "y" ? size : 30,
      space: side === "y" ? 36 : 64,
      stroke: () => css("--soft"),
      grid: { stroke: () => css("--grid"), width: 1 },
      ticks: { stroke: () => css("--grid"), width: 1, size: 5 },
      values: (u, splits) => {
        const { min: low, max: high } = u.scales[side];
        const powers = log && (low < -3.01 || high > 4.01);
        return splits.map((v) => (v == null ? "" : tick(offAxis(v, log), powers)));
      },
    };
  }

  function options(figure, data, width) {
    const rows = data.spans.some((s) => s.label) ? Math.min(2, data.spans.length) : 0;
    return {
      width: width,
      height: Math.round(Math.min(Math.max(0.55 * width, 230), 360)),
      padding: [12 + 16 * rows, 14, 0, 0],
      cursor: { drag: { x: true, y: false, dist: 5 }, points: { size: 6 } },
      legend: { live: true },
      scales: {
        x: { time: false, range: (u, low, high) => [low, high] },
        y: { range: (u, low, high) => around(low, high, data.y.log) },
      },
      axes: [axis(data.x.label, data.x.log, "x"), axis(data.y.label, data.y.log, "y")],
      series: [
        { label: data.x.label, value: (u, v) => written(offAxis(v, data.x.log)) },
        ...data.series.map((s) => ({
          label: s.name || data.y.label,
          stroke: () => (dark.matches ? s.dark : s.light),
          width: s.width,
          dash: s.dashed ? [6, 4] : undefined,
          points: { show: false },
          spanGaps: false,
          value: (u, v) => written(offAxis(v, data.y.log)),
        })),
      ],
      hooks: { drawClear: [spans(data.spans, data.x.log)] },
    };
  }

  function button(bar, text, name, action) {
    const b = document.createElement("button");
    b.type = "button";
    b.textContent = text;
    b.title = name;
    b.setAttribute("aria-label", name);
    b.addEventListener("click", action);
    bar.appendChild(b);
  }

  function tools(figure, plot, data, whole) {
    const bar = document.createElement("div");
    bar.className = "tools";
    const set = (low, high) => {
      const [first, last] = whole;
      const span = Math.min(high - low, last - first);
      const from = Math.min(Math.max(low, first), last - span);
      plot.setScale("x", { min: from, max: from + span });
    };
    const move = (middle, stretch) => () => {
      const { min: low, max: high } = plot.scales.x;
      const centre = 0.5 * (low + high) + middle * (high - low);
      const half = 0.5 * stretch * (high - low);
      set(centre - half, centre + half);
    };
    button(bar, "whole", "Show all of it", () => set(whole[0], whole[1]));
    if (data.home) button(bar, "worst", "Show where the model is worst", () => set(data.home[0], data.home[1]));
    button(bar, "+", "Zoom in", move(0, 0.5));
    button(bar, MINUS, "Zoom out", move(0, 2));
    button(bar, "\u2190", "Move to the left", move(-0.5, 1));
    button(bar, "\u2192", "Move to the right", move(0.5, 1));
    figure.insertBefore(bar, figure.querySelector("svg"));
  }

  function enliven(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const picture = figure.querySelector("svg");
    const holder = document.createElement("div");
    holder.className = "plot";
    figure.insertBefore(holder, picture);
    figure.classList.add("live");
    const x = abscissa(data.x);
    const columns = [x, ...data.series.map((s) => ordinate(s))];
    const plot = new uPlot(options(figure, data, holder.clientWidth), columns, holder);
    const ends = data.range && data.range.map((v) => onAxis(v, data.x.log));
    const whole = ends || [x[0], x[x.length - 1]];
    plot.setScale("x", { min: whole[0], max: whole[1] });
    tools(figure, plot, data, whole);
    plot.over.addEventListener("dblclick", () => plot.setScale("x", { min: whole[0], max: whole[1] }));
    new ResizeObserver(() => {
      const width = holder.clientWidth;
      if (width > 0 && Math.abs(width - plot.width) > 1) {
        plot.setSize({ width: width, height: Math.round(Math.min(Math.max(0.55 * width, 230), 360)) });
      }
    }).observe(holder);
    plots.push(plot);
  }

  for (const figure of document.querySelectorAll("figure")) {
    if (!figure.querySelector("script")) continue;
    try {
      enliven(figure);
    } catch (error) {
      figure.classList.remove("live");
      const made = figure.querySelector(".plot");
      if (made) made.remove();
      console.error(error);
    }
  }
  dark.addEventListener("change", () => plots.forEach((plot) => plot.redraw(false)));
})();
