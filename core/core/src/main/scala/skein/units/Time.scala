package skein.units

/** A point in time: nanoseconds since the epoch of the clock that was read. Instants of two clocks (the
  * controller's and the simulator's) must not be subtracted without the offset between them; the names of
  * fields state the clock.
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

/** A duration in nanoseconds; may be negative. */
opaque type Span = Long

object Span:
  val Zero: Span = 0L

  inline def ofNanos(nanos: Long): Span = nanos

  inline def ofMillis(millis: Double): Span = math.round(millis * 1e6)

  inline def ofSeconds(seconds: Double): Span = math.round(seconds * 1e9)

  /** Reads a duration with its unit, for example `100ms`, `1.5 s`, `2 min`, `1h`; zero or more.
    *
    * @return Left says what was expected and what was received
    */
  def parse(text: String): Either[String, Span] =
    text.trim match
      case withUnit(number, unit)
          if nanosOf.contains(unit) && number.toDouble * nanosOf(unit) < Long.MaxValue =>
        Right((BigDecimal(number) * nanosOf(unit)).setScale(0, BigDecimal.RoundingMode.HALF_UP).toLong)
      case negative if negative.startsWith("-") =>
        Left(s"expected a duration that is not negative, got '$text'")
      case number =>
        val example = if number.matches(digits) then s"${number}s" else "100ms"
        Left(s"expected a duration with unit, such as $example, got '$text'")

  private val digits   = """\d+(?:\.\d+)?"""
  private val withUnit = s"($digits)\\s*([a-zµ]+)".r

  private val nanosOf: Map[String, Double] = Seq(
    1.0     -> "ns nano nanos nanosecond nanoseconds",
    1e3     -> "us µs micro micros microsecond microseconds",
    1e6     -> "ms milli millis millisecond milliseconds",
    1e9     -> "s sec secs second seconds",
    60e9    -> "m min mins minute minutes",
    3600e9  -> "h hr hrs hour hours",
    86400e9 -> "d day days"
  ).flatMap((nanos, names) => names.split(' ').map(_ -> nanos)).toMap

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

    inline def toDuration: scala.concurrent.duration.FiniteDuration =
      scala.concurrent.duration.FiniteDuration(span, java.util.concurrent.TimeUnit.NANOSECONDS)
