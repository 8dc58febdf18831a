// Where a held pointer is, as soon as the browser knows: it hands on `pointermove` only once a
// picture, which is late where pictures come slowly.

export const MOVE = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
