package skein.vtime.agent;

import java.time.Clock;
import java.time.Instant;
import java.time.ZoneId;
import java.util.Objects;

/** The system's clock as {@link Redirect} tells it to the thread that reads it. */
final class RedirectedClock extends Clock {
  private final ZoneId zone;

  RedirectedClock(ZoneId zone) {
    this.zone = Objects.requireNonNull(zone, "zone");
  }

  @Override
  public ZoneId getZone() {
    return zone;
  }

  @Override
  public Clock withZone(ZoneId other) {
    return new RedirectedClock(other);
  }

  @Override
  public Instant instant() {
    return Redirect.instantNow();
  }

  @Override
  public long millis() {
    return Redirect.currentTimeMillis();
  }

  @Override
  public String toString() {
    return "RedirectedClock[" + zone + "]";
  }
}
