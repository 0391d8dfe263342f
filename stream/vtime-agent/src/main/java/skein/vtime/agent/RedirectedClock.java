package skein.vtime.agent;

import java.time.Clock;
import java.time.Instant;
import java.time.ZoneId;
import java.util.Objects;
import java.util.function.LongSupplier;
import java.util.function.Supplier;

/** The system's clock, as the redirected calls report it to the reading thread. */
final class RedirectedClock extends Clock {
  private final ZoneId zone;
  private final Supplier<Instant> instant;
  private final LongSupplier millis;

  RedirectedClock(ZoneId zone, Supplier<Instant> instant, LongSupplier millis) {
    this.zone = Objects.requireNonNull(zone, "zone");
    this.instant = instant;
    this.millis = millis;
  }

  @Override
  public ZoneId getZone() {
    return zone;
  }

  @Override
  public Clock withZone(ZoneId other) {
    return new RedirectedClock(other, instant, millis);
  }

  @Override
  public Instant instant() {
    return instant.get();
  }

  @Override
  public long millis() {
    return millis.getAsLong();
  }

  @Override
  public String toString() {
    return "RedirectedClock[" + zone + "]";
  }
}
