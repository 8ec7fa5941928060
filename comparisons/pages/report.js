"use strict";

// Every mechanism steps through its stations: paths, names and values are those of the one that is chosen.
for (const box of document.querySelectorAll("[data-stepper]")) {
  const stations = JSON.parse(box.querySelector("script").textContent);
  const [chosen, said, controls] = ["input", "output", ".steps"].map((what) => box.querySelector(what));
  const [paths, names, cells] = ["data-moves", "data-stands", "data-says"].map((what) => [...box.querySelectorAll(`[${what}]`)]);
  const words = cells.map((cell) => cell.className && "words");
  const show = () => {
    const [label, shapes, places, texts] = stations[chosen.value];
    said.textContent = label;
    chosen.setAttribute("aria-valuetext", label);
    paths.forEach((path, i) => path.setAttribute("d", shapes[i]));
    // a name that the right edge would cut stands on the left side of the point
    names.forEach((name, i) => {
      const cut = Number.parseFloat(places[i]) + 12 + name.getComputedTextLength() > name.ownerSVGElement.viewBox.baseVal.width;
      name.setAttribute("transform", `translate(${places[i]})`);
      name.setAttribute("text-anchor", cut ? "end" : "start");
      name.setAttribute("x", cut ? -12 : 12);
    });
    cells.forEach((cell, i) => {
      cell.textContent = texts[i];
      if (words[i]) cell.className = `words ${texts[i]}`;
    });
  };
  chosen.addEventListener("input", show);
  for (const button of controls.querySelectorAll("button")) {
    button.addEventListener("click", () => {
      chosen.value = Number(chosen.value) + Number(button.dataset.by);
      show();
    });
  }
  chosen.value = stations.length - 1;
  show();
  controls.hidden = stations.length < 2;
}

// Every table is sorted by the column whose heading is pressed; what has no number comes last.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const heads = [...table.querySelectorAll("thead th")];
  const worth = (cell) => {
    const text = cell.textContent.trim();
    const number = /^\(?([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)/.exec(text.replaceAll("−", "-"));
    return { text, number: number ? Number(number[1]) : NaN, empty: text === "" || text === "–" };
  };
  const compare = (a, b) => {
    if (!Number.isNaN(a.number) && !Number.isNaN(b.number)) return a.number - b.number;
    return a.text.localeCompare(b.text, "en", { numeric: true });
  };
  heads.forEach((head, place) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const rows = [...body.rows].map((row) => ({ row, value: worth(row.cells[place]) }));
      rows.sort((a, b) => a.value.empty - b.value.empty || sign * compare(a.value, b.value));
      body.append(...rows.map(({ row }) => row));
    });
  });
}
