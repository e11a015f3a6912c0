// Which part of the picture is seen: zoom and place, in CSS pixels of the canvas.

/** Pixels of the display in a CSS pixel. */
export function displayRatio(): number {
  return window.devicePixelRatio || 1;
}

export class View {
  zoom = 1; // CSS pixels a pixel
  x = 0; // the picture's point in the middle of the pane, in pixels
  y = 0;
  isFit = true;
  paneWidth = 1;
  paneHeight = 1;
  width = 1;
  height = 1;

  private get fitZoom() {
    return Math.min(this.paneWidth / this.width, this.paneHeight / this.height);
  }
  resize(paneWidth: number, paneHeight: number, width: number, height: number) {
    if (width !== this.width || height !== this.height) {
      this.x = (this.x / this.width) * width || width / 2;
      this.y = (this.y / this.height) * height || height / 2;
      this.zoom *= this.width / width;
    }
    [this.paneWidth, this.paneHeight, this.width, this.height] = [paneWidth, paneHeight, width, height];
    if (this.isFit) this.fit();
    else this.clamp();
  }
  fit() {
    this.isFit = true;
    this.zoom = this.fitZoom;
    this.x = this.width / 2;
    this.y = this.height / 2;
  }
  /** Zooms about a point of the pane, which stays where it is. */
  zoomTo(zoom: number, paneX = this.paneWidth / 2, paneY = this.paneHeight / 2) {
    const next = Math.min(96, Math.max(Math.min(this.fitZoom, 1 / displayRatio()), zoom));
    const [atX, atY] = this.toPicture(paneX, paneY);
    this.isFit = next === this.fitZoom;
    this.zoom = next;
    this.x = atX - (paneX - this.paneWidth / 2) / next;
    this.y = atY - (paneY - this.paneHeight / 2) / next;
    this.clamp();
  }
  pan(dx: number, dy: number) {
    this.x -= dx / this.zoom;
    this.y -= dy / this.zoom;
    this.clamp();
  }
  show(x: number, y: number) {
    const [paneX, paneY] = this.toPane(x + 0.5, y + 0.5);
    if (paneX < 0 || paneY < 0 || paneX > this.paneWidth || paneY > this.paneHeight) {
      this.x = x + 0.5;
      this.y = y + 0.5;
      this.clamp();
    }
  }
  toPicture(paneX: number, paneY: number): [number, number] {
    return [this.x + (paneX - this.paneWidth / 2) / this.zoom, this.y + (paneY - this.paneHeight / 2) / this.zoom];
  }
  toPane(x: number, y: number): [number, number] {
    return [(x - this.x) * this.zoom + this.paneWidth / 2, (y - this.y) * this.zoom + this.paneHeight / 2];
  }
  /** What is larger than the pane fills it; what is smaller stands in its middle. */
  private clamp() {
    const along = (at: number, size: number, pane: number) => {
      const half = pane / this.zoom / 2;
      return 2 * half >= size ? size / 2 : Math.min(size - half, Math.max(half, at));
    };
    this.x = along(this.x, this.width, this.paneWidth);
    this.y = along(this.y, this.height, this.paneHeight);
  }
}
