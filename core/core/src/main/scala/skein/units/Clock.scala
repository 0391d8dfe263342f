package skein.units

import skein.units.Instant

/** The only source of time in live code, so that the code also runs in virtual time. */
trait Clock:
  /** Nanoseconds since the Unix epoch; never runs backwards. */
  def now(): Instant

object Clock:

  /** The machine's monotonic clock, set to the Unix epoch once, when this object is created. */
  val system: Clock = new Clock:
    private val epochNanos =
      val wall = java.time.Instant.now()
      wall.getEpochSecond * 1_000_000_000L + wall.getNano - System.nanoTime()

    def now(): Instant = Instant.ofNanos(epochNanos + System.nanoTime())

  /** A clock that reads nanoseconds since the Unix epoch from a function, for example virtual time. */
  def ofNanos(nanos: () => Long): Clock = () => Instant.ofNanos(nanos())
