/** A WebSocket to the server that comes back by itself. */
export class Connection {
  constructor(onPose, onState) {
    Object.assign(this, { onPose, onState, wait: 250, received: 0 });
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    this.socket = socket;
    socket.addEventListener('open', () => {
      this.wait = 250;
      this.onState('open');
    });
    socket.addEventListener('message', ({ data }) => {
      ++this.received;
      this.onPose(JSON.parse(data));
    });
    socket.addEventListener('close', () => {
      this.onState('closed');
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, 2000);
    });
  }

  /** Asks for the pose of a log's tick. */
  ask(k) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(String(k));
  }
}
