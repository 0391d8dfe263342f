package skein.mcap

/** Receives a writer's output, in order. */
trait ByteSink:

  /** Consumes `array[from, until)` before it returns. */
  def write(array: Array[Byte], from: Int, until: Int): Unit
