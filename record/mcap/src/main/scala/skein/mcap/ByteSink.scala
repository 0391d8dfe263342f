package skein.mcap

/** Takes what a writer writes, in order. */
trait ByteSink:

  /** `array[from, until)`, which it must have used up when it returns. */
  def write(array: Array[Byte], from: Int, until: Int): Unit
