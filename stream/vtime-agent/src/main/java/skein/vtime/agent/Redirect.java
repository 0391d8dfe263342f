package skein.vtime.agent;

import java.time.Clock;
import java.time.Duration;
import java.time.Instant;
import java.time.InstantSource;
import java.time.LocalDate;
import java.time.LocalDateTime;
import java.time.LocalTime;
import java.time.OffsetDateTime;
import java.time.ZoneId;
import java.time.ZoneOffset;
import java.time.ZonedDateTime;
import java.util.Date;
import java.util.Objects;
import java.util.Random;
import java.util.SplittableRandom;
import java.util.UUID;
import java.util.concurrent.ThreadLocalRandom;
import java.util.concurrent.TimeUnit;
import java.util.random.RandomGenerator;

/**
 * The targets of rewritten call sites. A thread that has an {@link Environment} is answered by it; any other
 * thread gets the JVM's answer, so live systems in this JVM are unaffected.
 *
 * <p>Public only because rewritten classes call it; {@link Rewriter} lists the method for each call.
 */
public final class Redirect {
  private static final ThreadLocal<Environment> ENVIRONMENT = new ThreadLocal<>();

  private static final InstantSource NOW =
      new InstantSource() {
        @Override
        public Instant instant() {
          return instantNow();
        }

        @Override
        public String toString() {
          return "Redirected";
        }
      };

  private Redirect() {}

  /** The calling thread's environment, or null. */
  public static Environment environment() {
    return ENVIRONMENT.get();
  }

  /** Sets the calling thread's environment; null removes it. */
  public static void setEnvironment(Environment environment) {
    if (environment == null) ENVIRONMENT.remove();
    else ENVIRONMENT.set(environment);
  }

  public static long nanoTime() {
    var environment = ENVIRONMENT.get();
    return environment == null ? System.nanoTime() : environment.nanoTime();
  }

  public static long currentTimeMillis() {
    var environment = ENVIRONMENT.get();
    return environment == null ? System.currentTimeMillis() : Math.floorDiv(environment.nanoTime(), 1_000_000L);
  }

  public static Instant instantNow() {
    var environment = ENVIRONMENT.get();
    return environment == null ? Instant.now() : instant(environment);
  }

  /**
   * A clock that reads the time of the calling thread; its zone is the machine's or, in an environment, UTC.
   */
  public static Clock clock() {
    return clock(ENVIRONMENT.get() == null ? ZoneId.systemDefault() : ZoneOffset.UTC);
  }

  public static Clock clock(ZoneId zone) {
    return NOW.withZone(Objects.requireNonNull(zone, "zone"));
  }

  public static Clock clockUtc() {
    return clock(ZoneOffset.UTC);
  }

  public static LocalDate localDateNow() {
    return LocalDate.now(clock());
  }

  public static LocalDate localDateNow(ZoneId zone) {
    return LocalDate.now(clock(zone));
  }

  public static LocalTime localTimeNow() {
    return LocalTime.now(clock());
  }

  public static LocalTime localTimeNow(ZoneId zone) {
    return LocalTime.now(clock(zone));
  }

  public static LocalDateTime localDateTimeNow() {
    return LocalDateTime.now(clock());
  }

  public static LocalDateTime localDateTimeNow(ZoneId zone) {
    return LocalDateTime.now(clock(zone));
  }

  public static OffsetDateTime offsetDateTimeNow() {
    return OffsetDateTime.now(clock());
  }

  public static OffsetDateTime offsetDateTimeNow(ZoneId zone) {
    return OffsetDateTime.now(clock(zone));
  }

  public static ZonedDateTime zonedDateTimeNow() {
    return ZonedDateTime.now(clock());
  }

  public static ZonedDateTime zonedDateTimeNow(ZoneId zone) {
    return ZonedDateTime.now(clock(zone));
  }

  public static Date newDate() {
    return new Date(currentTimeMillis());
  }

  private static Instant instant(Environment environment) {
    var nanos = environment.nanoTime();
    return Instant.ofEpochSecond(Math.floorDiv(nanos, 1_000_000_000L), Math.floorMod(nanos, 1_000_000_000L));
  }

  /** The generator to draw from in place of {@code real}. */
  public static RandomGenerator random(RandomGenerator real) {
    var environment = ENVIRONMENT.get();
    return environment == null ? real : environment.random();
  }

  /** The seed for a generator created without a seed, in place of one that it would choose. */
  public static long seed() {
    return random(ThreadLocalRandom.current()).nextLong();
  }

  public static Random newRandom() {
    return new Random(seed());
  }

  public static SplittableRandom newSplittableRandom() {
    return new SplittableRandom(seed());
  }

  public static RandomGenerator defaultGenerator() {
    return random(RandomGenerator.getDefault());
  }

  /**
   * Replaces the generator behind Scala's {@code Random} without a seed: its only instance outlives every
   * run.
   */
  public static Random governed(Random real) {
    return new GovernedRandom(Redirect::environment);
  }

  public static double mathRandom() {
    var environment = ENVIRONMENT.get();
    return environment == null ? Math.random() : environment.random().nextDouble();
  }

  /** Replaces an identity hash code, which differs from run to run; the caller stores it. */
  public static int hashCodeOf(Object object) {
    var environment = ENVIRONMENT.get();
    return environment == null ? System.identityHashCode(object) : environment.random().nextInt() | 1;
  }

  /** A version 4 UUID, as {@link UUID#randomUUID} makes. */
  public static UUID randomUuid() {
    var environment = ENVIRONMENT.get();
    if (environment == null) return UUID.randomUUID();
    var version4 = environment.random().nextLong() & 0xffff_ffff_ffff_0fffL | 0x4000L;
    var variant2 = environment.random().nextLong() & 0x3fff_ffff_ffff_ffffL | 0x8000_0000_0000_0000L;
    return new UUID(version4, variant2);
  }

  private static void refuse(String wait) {
    var environment = ENVIRONMENT.get();
    if (environment != null) throw environment.blocked(wait);
  }

  public static void sleep(long millis) throws InterruptedException {
    refuse("Thread.sleep(" + millis + " ms)");
    Thread.sleep(millis);
  }

  public static void sleep(Duration duration) throws InterruptedException {
    refuse("Thread.sleep(" + duration + ")");
    Thread.sleep(duration);
  }

  public static void sleep(long millis, int nanos) throws InterruptedException {
    refuse("Thread.sleep(" + millis + " ms, " + nanos + " ns)");
    Thread.sleep(millis, nanos);
  }

  public static void sleep(TimeUnit unit, long timeout) throws InterruptedException {
    refuse("TimeUnit." + unit + ".sleep(" + timeout + ")");
    unit.sleep(timeout);
  }

  public static void submitted(Object executionContext) {
    var environment = ENVIRONMENT.get();
    if (environment != null) environment.submitted(executionContext);
  }

  public static String supervisorName(String real) {
    var environment = ENVIRONMENT.get();
    return environment == null ? real : environment.supervisorName();
  }

  public static void delivered(Object scheduler) {
    if (scheduler instanceof Guard guard) guard.delivered();
  }
}
