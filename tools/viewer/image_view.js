// The geometry image: a picture of the samples, and a cross at the marked one.

export class ImageView {
  // onPoint(row, column): the pointer or a key marks a sample; null: none.
  constructor(canvas, cross, onPoint) {
    this.canvas = canvas;
    this.cross = cross;
    this.onPoint = onPoint;
    this.place = null; // [row, column]
    canvas.addEventListener("pointermove", (event) => this.point(event));
    canvas.addEventListener("pointerdown", (event) => this.point(event));
    canvas.addEventListener("keydown", (event) => this.step(event));
    new ResizeObserver(() => this.fit()).observe(canvas.parentElement);
  }

  // part: {width, height, first}. colours: three bytes a vertex. Samples without a position are left clear.
  show(part, colours, positions) {
    const { width, height, first } = part;
    this.part = part;
    this.canvas.width = width;
    this.canvas.height = height;
    const picture = new ImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      const v = first + i;
      for (let k = 0; k < 3; ++k) picture.data[4 * i + k] = colours[3 * v + k];
      picture.data[4 * i + 3] = Number.isNaN(positions[3 * v]) ? 0 : 255;
    }
    this.canvas.getContext("2d").putImageData(picture, 0, 0);
    this.fit();
  }
  // As large as the frame lets it be.
  fit() {
    if (!this.part) return;
    const frame = this.canvas.parentElement, { width, height } = this.part;
    const scale = Math.min(frame.clientWidth / width, frame.clientHeight / height);
    this.size = [Math.floor(width * scale), Math.floor(height * scale)];
    for (const canvas of [this.canvas, this.cross]) {
      canvas.style.width = `${this.size[0]}px`;
      canvas.style.height = `${this.size[1]}px`;
    }
    [this.cross.width, this.cross.height] = this.size;
    this.mark(this.place);
  }
  mark(place) {
    this.place = place;
    const context = this.cross.getContext("2d");
    context.clearRect(0, 0, this.cross.width, this.cross.height);
    if (!place || !this.part) return;
    const x = ((place[1] + 0.5) / this.part.width) * this.size[0], y = ((place[0] + 0.5) / this.part.height) * this.size[1];
    for (const [style, width] of [["#ffffff", 4], ["#d01070", 2]]) {
      context.strokeStyle = style;
      context.lineWidth = width;
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + 4 * dx, y + 4 * dy);
        context.lineTo(x + 14 * dx, y + 14 * dy);
      }
      context.stroke();
    }
  }
  point(event) {
    if (!this.part) return;
    const frame = this.canvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - frame.left) / frame.width) * this.part.width);
    const row = Math.floor(((event.clientY - frame.top) / frame.height) * this.part.height);
    this.choose(row, column);
  }
  step(event) {
    const way = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    if (!way || !this.part) return;
    event.preventDefault();
    const [row, column] = this.place ?? [this.part.height >> 1, this.part.width >> 1], far = event.shiftKey ? 8 : 1;
    this.choose(row + far * way[0], column + far * way[1]);
  }
  choose(row, column) {
    const inside = (value, size) => Math.min(Math.max(value, 0), size - 1);
    this.onPoint(inside(row, this.part.height), inside(column, this.part.width));
  }
}
