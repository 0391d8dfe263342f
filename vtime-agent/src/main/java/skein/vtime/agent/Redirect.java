package skein.vtime.agent;

import java.time.Duration;
import java.time.Instant;
import java.time.LocalDateTime;
import java.time.ZoneOffset;
import java.util.UUID;
import java.util.concurrent.ThreadLocalRandom;
import java.util.random.RandomGenerator;

/**
 * Where rewritten call sites lead. A thread that has an {@link Environment} is answered by it; any other thread gets
 * what the JVM would have said, so live systems in the same JVM are undisturbed.
 *
 * <p>Public only because rewritten classes call it; {@link Rewriter} lists which call becomes which method.
 */
public final class Redirect {
  private static final ThreadLocal<Environment> ENVIRONMENT = new ThreadLocal<>();

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

  public static LocalDateTime localDateTimeNow() {
    var environment = ENVIRONMENT.get();
    return environment == null ? LocalDateTime.now() : LocalDateTime.ofInstant(instant(environment), ZoneOffset.UTC);
  }

  private static Instant instant(Environment environment) {
    var nanos = environment.nanoTime();
    return Instant.ofEpochSecond(Math.floorDiv(nanos, 1_000_000_000L), Math.floorMod(nanos, 1_000_000_000L));
  }

  private static RandomGenerator random(RandomGenerator real) {
    var environment = ENVIRONMENT.get();
    return environment == null ? real : environment.random();
  }

  public static int nextInt(ThreadLocalRandom real) {
    return random(real).nextInt();
  }

  public static int nextInt(ThreadLocalRandom real, int bound) {
    return random(real).nextInt(bound);
  }

  public static int nextInt(ThreadLocalRandom real, int origin, int bound) {
    return random(real).nextInt(origin, bound);
  }

  public static long nextLong(ThreadLocalRandom real) {
    return random(real).nextLong();
  }

  public static long nextLong(ThreadLocalRandom real, long bound) {
    return random(real).nextLong(bound);
  }

  public static long nextLong(ThreadLocalRandom real, long origin, long bound) {
    return random(real).nextLong(origin, bound);
  }

  public static double nextDouble(ThreadLocalRandom real) {
    return random(real).nextDouble();
  }

  public static double nextDouble(ThreadLocalRandom real, double bound) {
    return random(real).nextDouble(bound);
  }

  public static double nextDouble(ThreadLocalRandom real, double origin, double bound) {
    return random(real).nextDouble(origin, bound);
  }

  public static double nextGaussian(ThreadLocalRandom real) {
    return random(real).nextGaussian();
  }

  public static boolean nextBoolean(ThreadLocalRandom real) {
    return random(real).nextBoolean();
  }

  public static void nextBytes(ThreadLocalRandom real, byte[] bytes) {
    random(real).nextBytes(bytes);
  }

  public static double mathRandom() {
    var environment = ENVIRONMENT.get();
    return environment == null ? Math.random() : environment.random().nextDouble();
  }

  /** In place of an identity's hash code, which differs from run to run; the caller keeps it. */
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

  public static void sleep(long millis) throws InterruptedException {
    var environment = ENVIRONMENT.get();
    if (environment != null) throw environment.blocked("Thread.sleep(" + millis + " ms)");
    Thread.sleep(millis);
  }

  public static void sleep(Duration duration) throws InterruptedException {
    var environment = ENVIRONMENT.get();
    if (environment != null) throw environment.blocked("Thread.sleep(" + duration + ")");
    Thread.sleep(duration);
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
