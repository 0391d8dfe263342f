package skein.units

/** A point in time: nanoseconds since the epoch of the clock that was read. Instants of two clocks (the
  * controller's and the simulator's) must not be subtracted without the offset between them; field names say whose
  * clock it is.
  */
opaque type Instant = Long

object Instant:
  val Epoch: Instant = 0L

  inline def ofNanos(nanos: Long): Instant = nanos

  given Ordering[Instant] = Ordering.Long

  extension (instant: Instant)
    inline def toNanos: Long                 = instant
    inline def toSeconds: Double             = instant * 1e-9
    inline def +(span: Span): Instant        = instant + span.toNanos
    inline def -(span: Span): Instant        = instant - span.toNanos
    inline def since(earlier: Instant): Span = Span.ofNanos(instant - earlier)
    inline def <(other: Instant): Boolean    = instant < other
    inline def <=(other: Instant): Boolean   = instant <= other
    inline def >(other: Instant): Boolean    = instant > other
    inline def >=(other: Instant): Boolean   = instant >= other
    inline def max(other: Instant): Instant  = math.max(instant, other)
    inline def min(other: Instant): Instant  = math.min(instant, other)

/** A length of time in nanoseconds; may be negative. */
opaque type Span = Long

object Span:
  val Zero: Span = 0L

  inline def ofNanos(nanos: Long): Span = nanos

  /** Rounds to the nearest nanosecond. */
  inline def ofMillis(millis: Double): Span = math.round(millis * 1e6)

  /** Rounds to the nearest nanosecond. */
  inline def ofSeconds(seconds: Double): Span = math.round(seconds * 1e9)

  given Ordering[Span] = Ordering.Long

  extension (span: Span)
    inline def toNanos: Long            = span
    inline def toMillis: Double         = span * 1e-6
    inline def toSeconds: Double        = span * 1e-9
    inline def +(other: Span): Span     = span + other
    inline def -(other: Span): Span     = span - other
    inline def *(factor: Long): Span    = span * factor
    inline def /(divisor: Long): Span   = span / divisor
    inline def <(other: Span): Boolean  = span < other
    inline def <=(other: Span): Boolean = span <= other
    inline def >(other: Span): Boolean  = span > other
    inline def >=(other: Span): Boolean = span >= other
    inline def max(other: Span): Span   = math.max(span, other)
    inline def min(other: Span): Span   = math.min(span, other)

    /** For Pekko's and Java's interfaces. */
    inline def toDuration: scala.concurrent.duration.FiniteDuration =
      scala.concurrent.duration.FiniteDuration(span, java.util.concurrent.TimeUnit.NANOSECONDS)
