package skein.forward

/** Seconds as whole nanoseconds. */
private[skein] object Nanos:
  def of(seconds: Double): Long = math.round(seconds * 1e9)
