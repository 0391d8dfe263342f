package skein.vtime.listed

import java.time.Instant
import java.util.UUID
import java.util.concurrent.ThreadLocalRandom
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.concurrent.duration.*
import scala.util.Try
import skein.vtime.{VirtualTime, VirtualTimeException}

/** Reads every clock and draws from every source that the agent redirects; run with this package named to it. */
@main def readEverything(): Unit =
  def readings() =
    Seq(
      Instant.now,
      System.nanoTime == References.NANO_TIME.getAsLong && System.currentTimeMillis == System.nanoTime / 1_000_000,
      ThreadLocalRandom.current.nextInt(1000),
      ThreadLocalRandom.current.nextGaussian(),
      Math.random(),
      UUID.randomUUID
    ).mkString(";")

  def read() = VirtualTime.run(5): system =>
    after(1500.millis)(Future.fromTry(Try(readings())))(using system)
  .value
  val slept =
    try VirtualTime.run(5)(_ => Future.successful(Thread.sleep(10))).toString
    catch case error: VirtualTimeException => error.problem.toString
  println(s"${read()};$slept;${read()}")
