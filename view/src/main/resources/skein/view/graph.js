// The control graph as it runs: where its stages are is the server's to say; here are the numbers on its edges.

const svg = (name, attributes, text) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
};

export class Graph {
  constructor(section) {
    this.section = section;
    this.place = section.querySelector("div");
    this.shape = undefined;
  }
}
