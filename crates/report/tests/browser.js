// Run in a page by its test: what a reader would see as broken. Writes one fault a line, and that
// it has run.
"use strict";
window.addEventListener("load", () => setTimeout(() => {
  const faults = window.pageFaults;
  const box = (e) => e.getBoundingClientRect();
  const name = (e) => `${e.tagName} ${(e.className && e.className.baseVal) || e.className || ""} '${(e.textContent || "").trim().slice(0, 40)}'`;
  const seen = (e) => e.checkVisibility() && box(e).width > 0 && box(e).height > 0;
  // A hair of overlap is rounding.
  const HAIR = 1.5;
  const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > HAIR
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > HAIR;

  for (const fold of document.querySelectorAll("details")) fold.open = true;
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) {
    faults.push(`scrolls sideways: ${document.documentElement.scrollWidth} in ${width} px`);
  }
  const figures = [...document.querySelectorAll("figure")];
  for (const figure of figures) {
    const live = figure.querySelector("script") !== null;
    const picture = figure.querySelector(live ? ".plot canvas" : "svg");
    if (!picture || !seen(picture)) faults.push(`not drawn: ${name(figure)}`);
    if (live && picture) {
      const data = picture.getContext("2d").getImageData(0, 0, picture.width, picture.height).data;
      if (!data.some((v) => v !== 0)) faults.push(`empty canvas: ${name(figure)}`);
    }
  }
  // Blocks beside and below one another.
  for (const parent of document.querySelectorAll("body,header,main,.pair,.tiles,figure,details,dl,.tools,tr")) {
    const blocks = [...parent.children].filter((e) => !/SCRIPT|STYLE/.test(e.tagName) && seen(e));
    blocks.forEach((a, i) => blocks.slice(i + 1).forEach((b) => {
      if (overlap(box(a), box(b))) faults.push(`overlap: ${name(a)} and ${name(b)}`);
    }));
    for (const block of blocks) {
      if (box(block).right > width + HAIR || box(block).left < -HAIR) faults.push(`outside the page: ${name(block)}`);
    }
  }
  // Words inside the drawings, those under a canvas too.
  for (const figure of figures) figure.classList.remove("live");
  for (const figure of figures) {
    const svg = figure.querySelector("svg");
    if (!svg) continue;
    const words = [...svg.querySelectorAll("text")];
    const edge = box(svg);
    words.forEach((a, i) => {
      const at = box(a);
      if (at.left < edge.left - HAIR || at.right > edge.right + HAIR) faults.push(`cut off: ${name(a)} in ${name(figure)}`);
      words.slice(i + 1).forEach((b) => {
        if (overlap(at, box(b))) faults.push(`overlap in ${name(figure)}: ${name(a)} and ${name(b)}`);
      });
    });
  }
  const result = document.createElement("pre");
  result.id = "page-check";
  result.textContent = [`figures ${figures.length}`, `width ${width}`, ...faults].join("\n");
  document.body.replaceChildren(result);
}, 300));
