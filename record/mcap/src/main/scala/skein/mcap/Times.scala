package skein.mcap

/** The earliest and latest of unsigned times; 0 and 0 without any, as the specification requires. */
private[mcap] final class Times:
  private var any   = false
  private var least = 0L
  private var most  = 0L

  def start: Long = least
  def end: Long   = most

  def add(time: Long): Unit =
    if !any then
      any = true
      least = time
      most = time
    else
      if java.lang.Long.compareUnsigned(time, least) < 0 then least = time
      if java.lang.Long.compareUnsigned(time, most) > 0 then most = time

  def clear(): Unit =
    any = false
    least = 0
    most = 0
