// Chromium in the C locale names its language en-US@posix, which no formatter takes: uPlot would not load.
try {
  new Intl.NumberFormat(navigator.language);
} catch {
  Object.defineProperty(navigator, "language", { value: "en-US" });
}
