// Tabs as the WAI-ARIA practice has them: arrow keys move along, the shown panel is labelled.

import { tellShown } from "/page/switches.js";

const KEPT = "polypod.tab";

// `panels` are [title, mount]; each is mounted once, and shown when its tab is chosen.
export function mountTabs(list, page, panels) {
  const tabs = panels.map(([title, mount], i) => {
    const tab = document.createElement("button");
    tab.type = "button";
    tab.id = `tab-${title.toLowerCase()}`;
    tab.textContent = title;
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-controls", `panel-${title.toLowerCase()}`);
    list.append(tab);
    const panel = document.createElement("div");
    panel.id = `panel-${title.toLowerCase()}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", tab.id);
    page.append(panel);
    mount(panel);
    tab.addEventListener("click", () => choose(i));
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const next = (i + step + panels.length) % panels.length;
      choose(next);
      tabs[next].tab.focus();
    });
    return { title, tab, panel };
  });

  function choose(chosen) {
    tabs.forEach(({ tab, panel }, i) => {
      tab.setAttribute("aria-selected", String(i === chosen));
      tab.tabIndex = i === chosen ? 0 : -1;
      panel.hidden = i !== chosen;
    });
    localStorage.setItem(KEPT, tabs[chosen].title);
    tellShown();
  }

  const kept = tabs.findIndex(({ title }) => title === localStorage.getItem(KEPT));
  choose(kept < 0 ? 0 : kept);
}
