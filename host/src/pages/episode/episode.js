"use strict";
// Everything that can be shown stands in the page; this only chooses what is visible.
(() => {
  const panel = document.getElementById("evidence");
  const beside = panel.parentElement;
  const marks = [...document.querySelectorAll(".plan a.thing")];
  let pinned = null;

  const described = (mark) => document.getElementById(mark.getAttribute("href").slice(1));

  const show = (mark) => {
    marks.forEach((other) => other.classList.toggle("shown", other === mark));
    panel.replaceChildren(...[...described(mark).cloneNode(true).childNodes]);
    panel.hidden = false;
    beside.classList.add("with-evidence");
  };

  for (const mark of marks) {
    // The panel says what the browser's own hint would say.
    mark.querySelector("title")?.remove();
    mark.addEventListener("pointerenter", (event) => { if (event.pointerType === "mouse") show(mark); });
    mark.addEventListener("pointerleave", () => { if (pinned) show(pinned); });
    mark.addEventListener("focus", () => show(mark));
    mark.addEventListener("click", (event) => {
      event.preventDefault();
      pinned = mark;
      show(mark);
      // A click without a pointer comes from the keyboard: whoever listens is led to what is to be read.
      if (event.detail === 0) panel.focus();
      panel.scrollIntoView({ block: "nearest" });
    });
  }
  // What was asked about first shows what can be seen of every thing.
  const first = document.querySelector(".dialogue a")?.getAttribute("href");
  pinned = marks.find((mark) => mark.getAttribute("href") === first) ?? marks[0] ?? null;
  if (pinned) show(pinned);

  panel.addEventListener("keydown", (event) => { if (event.key === "Escape" && pinned) pinned.focus(); });

  // A link to a thing opens it.
  const open = () => document.getElementById(location.hash.slice(1))?.closest("details")?.setAttribute("open", "");
  addEventListener("hashchange", open);
  open();

  const slider = document.getElementById("step");
  if (!slider) return;
  slider.closest("p").hidden = false;
  const output = slider.parentElement.querySelector("output");
  const go = () => {
    const step = Number(slider.value);
    output.textContent = `${step} of ${slider.max}`;
    for (const mark of marks) {
      for (const state of mark.querySelectorAll("[data-from]")) {
        const now = Number(state.dataset.from) <= step && step <= Number(state.dataset.to);
        state.classList.toggle("past", !now);
        if (now && state.dataset.said) mark.setAttribute("aria-label", `${mark.dataset.name}: ${state.dataset.said}`);
      }
    }
    document.querySelectorAll(".dialogue li").forEach((item) => item.classList.toggle("now", Number(item.dataset.step) === step));
  };
  slider.addEventListener("input", go);
  // A browser may keep the slider where it was when the page is loaded again.
  go();
})();
