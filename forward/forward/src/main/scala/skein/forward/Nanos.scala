package skein.forward

/** Converts seconds to whole nanoseconds, rounded. */
private[skein] object Nanos:
  def of(seconds: Double): Long = math.round(seconds * 1e9)
