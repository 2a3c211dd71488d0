// A camera that circles around a point: one finger or the left button turns it, two fingers or the right button shift it,
// pinch or wheel zoom. z stays up.
const angle = 32 * Math.PI / 180;
const views = { oblique: [-62, 22], front: [-90, 0], side: [0, 0], top: [-90, 90] };

class Camera {
  // box: {low, high} of what is to be seen.
  constructor(box) {
    this.box = box;
    this.look("oblique");
  }

  look(name) {
    const [azimuth, height] = views[name];
    this.azimuth = azimuth * Math.PI / 180;
    this.height = height * Math.PI / 180;
    this.fit = true;  // until the camera is moved
  }

  // Comes as close as shows the whole box.
  frame(aspect) {
    const { low, high } = this.box, tan = Math.tan(angle / 2), [right, up, back] = this.axes();
    this.target = scale(0.5, add(low, high));
    this.distance = 1e-3;
    for (let corner = 0; corner < 8; ++corner) {
      const off = low.map((_, a) => (corner >> a & 1 ? high[a] : low[a]) - this.target[a]);
      const across = Math.max(Math.abs(dot(off, up)), Math.abs(dot(off, right)) / aspect) / tan;
      this.distance = Math.max(this.distance, 1.06 * across + dot(off, back));
    }
  }

  axes() {
    const [ca, sa, ch, sh] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.height), Math.sin(this.height)];
    const back = [ca * ch, sa * ch, sh], right = [-sa, ca, 0];
    return [right, cross(back, right), back];
  }

  matrices(width, height) {
    const aspect = width / height;
    if (this.fit) this.frame(aspect);
    const axes = this.axes(), eye = add(this.target, scale(this.distance, axes[2]));
    const near = Math.max(this.distance - 3, this.distance * 0.02);
    return { eye, axes, tangent: Math.tan(angle / 2), view: view(eye, axes),
      projection: perspective(angle, aspect, near, this.distance + 4) };
  }

  turn(dx, dy) {
    this.fit = false;
    this.azimuth -= dx;
    this.height = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.height + dy));
  }

  // By shares of the picture's height.
  shift(dx, dy) {
    this.fit = false;
    const [right, up] = this.axes(), size = 2 * this.distance * Math.tan(angle / 2);
    this.target = add(this.target, add(scale(-dx * size, right), scale(dy * size, up)));
  }

  closer(factor) {
    this.fit = false;
    this.distance = Math.min(20, Math.max(0.02, this.distance * factor));
  }
}

// Lets pointers, wheel and keys move the camera; `changed` draws anew, `clicked(x, y)` is a press that did not move.
function steer(canvas, camera, changed, clicked) {
  const down = new Map();
  let moved = 0, pinch = 0;
  const span = () => {
    const [a, b] = [...down.values()];
    return { size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY, button: event.button });
    moved = down.size > 1 ? 99 : 0;
    if (down.size === 2) pinch = span();
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y, size = canvas.clientHeight;
    moved += Math.abs(dx) + Math.abs(dy);
    Object.assign(last, { x: event.clientX, y: event.clientY });
    if (down.size === 2) {
      const now = span();
      camera.shift((now.x - pinch.x) / size, (now.y - pinch.y) / size);
      if (now.size > 0 && pinch.size > 0) camera.closer(pinch.size / now.size);
      pinch = now;
    } else if (last.button === 2 || last.button === 1 || event.shiftKey) {
      camera.shift(dx / size, dy / size);
    } else {
      camera.turn(dx / size * 3.2, dy / size * 3.2);
    }
    changed();
  });
  const up = (event) => {
    const was = down.get(event.pointerId);
    down.delete(event.pointerId);
    if (was && moved < 4 && event.type === "pointerup" && clicked) clicked(event.offsetX, event.offsetY);
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.closer(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.002));
    changed();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => { camera.fit = true; changed(); });
}
