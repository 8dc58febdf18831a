// Drags. A held pointer is followed as soon as the browser knows where it is: it hands on
// `pointermove` only once a picture, which is late where pictures come slowly.

export const MOVE = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";

// Let an element be dragged. `take(event)` returns what is held from now on, or null where nothing
// is; `follow(event, held)` hears where the pointer goes with it, `release()` that it let go. What
// is held has the focus: `focused`, where that is another element.
export function onDrag(element, { take, follow, release = () => {}, focused = element }) {
  let held = null;
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const taken = take(event);
    if (taken === null) return;
    event.preventDefault();
    focused.focus({ preventScroll: true });
    element.setPointerCapture(event.pointerId);
    held = taken;
  });
  element.addEventListener(MOVE, (event) => {
    if (held !== null) follow(event, held);
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    element.addEventListener(kind, () => {
      if (held === null) return;
      held = null;
      release();
    });
  }
}
