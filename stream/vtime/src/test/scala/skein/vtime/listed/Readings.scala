package skein.vtime.listed

import java.time.*
import java.util.concurrent.{ThreadLocalRandom, TimeUnit}
import java.util.random.RandomGenerator
import java.util.{Date, SplittableRandom, UUID}
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.concurrent.duration.*
import scala.util.{Random, Try}
import skein.vtime.{VirtualTime, VirtualTimeException}

/** Reads every clock, draws from every source and sleeps in every way that the agent redirects; the agent
  * must be given this package. Prints clocks, draws, the draws of another run, and sleeps, separated by bars,
  * with semicolons between values.
  */
@main def readEverything(): Unit =
  val tokyo = ZoneId.of("Asia/Tokyo")
  // Made before any run, as a constant of a live program is.
  val clock = Clock.systemUTC()

  def clocks() = Seq(
    Instant.now,
    System.nanoTime == References.NANO_TIME.getAsLong && System.currentTimeMillis == System.nanoTime / 1_000_000,
    LocalDate.now,
    LocalTime.now,
    LocalDateTime.now,
    OffsetDateTime.now,
    ZonedDateTime.now,
    LocalDate.now(tokyo),
    LocalTime.now(tokyo),
    LocalDateTime.now(tokyo),
    OffsetDateTime.now(tokyo),
    ZonedDateTime.now(tokyo),
    clock.instant,
    clock.withZone(tokyo).millis,
    Clock.systemDefaultZone.getZone,
    Clock.system(tokyo),
    Date().getTime,
    References.DATE.get.getTime
  )

  def draws() =
    val local = ThreadLocalRandom.current
    Seq(
      local.nextInt(1000),
      local.nextFloat(),
      local.nextFloat(3f),
      local.nextFloat(3f, 4f),
      local.nextLong(7, 700),
      local.nextDouble(2),
      local.nextGaussian(),
      local.nextGaussian(5, 2),
      local.nextExponential(),
      local.ints(3).boxed.toList,
      local.longs(2, 0, 100).boxed.toList,
      local.doubles(0, 1).limit(2).boxed.toList,
      java.util.Random().nextLong(),
      Derived().nextLong(),
      SplittableRandom().nextLong(),
      References.RANDOM.get.nextLong(),
      References.SPLITTABLE.get.nextLong(),
      RandomGenerator.getDefault.nextLong(),
      Random.nextInt(1000),
      Random.nextGaussian(),
      Random.shuffle(Vector.range(0, 20)),
      Random().between(0.0, 1.0),
      Math.random(),
      UUID.randomUUID
    )

  def read(readings: () => Seq[Any]) = VirtualTime
    .run(5): system =>
      after(1500.millis)(Future.fromTry(Try(readings().mkString(";"))))(using system)
    .value

  def stopped(sleep: => Unit) =
    try VirtualTime.run(5)(_ => Future.successful(sleep)).toString
    catch case error: VirtualTimeException => error.problem.toString

  val sleeps =
    Seq(stopped(Thread.sleep(10)), stopped(Thread.sleep(10, 5)), stopped(TimeUnit.SECONDS.sleep(1)))
  println(Seq(read(clocks), read(draws), read(draws), sleeps.mkString(";")).mkString("|"))

/** Calls the constructor, which the agent redirects like a call of its own superclass's constructor. */
private final class Derived extends java.util.Random
