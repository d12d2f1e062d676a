// The socket of a page: messages in by their kind, messages out, opened again after it closed.

export class Link {
  constructor(taken, lost) {
    Object.assign(this, { taken, lost, socket: null, leaving: false });
    window.addEventListener("pagehide", () => (this.leaving = true));
  }

  open() {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    this.socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(token)}`);
    this.socket.onmessage = ({ data }) => {
      const message = JSON.parse(data);
      this.taken[message.kind]?.(message);
    };
    this.socket.onclose = () => {
      this.lost();
      if (!this.leaving) setTimeout(() => this.open(), 1000);
    };
  }

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
