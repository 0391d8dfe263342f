package antenna

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.duration.*
import scala.concurrent.{Future, Promise}
import scala.util.Random
import skein.units.*

/** The world of the example: a balloon that drifts past, an antenna on a motor, and instruments behind a slow
  * link.
  */
final class Field(clock: Clock, seed: Long)(using system: ActorSystem):
  import system.dispatcher
  private val random   = Random(seed)
  private val start    = clock.now()
  private var azimuth  = 0.0
  private var rateRadS = 0.0
  private var turnedAt = start
  private var moving   = Promise[Boolean]()

  /** The track, once a second: time in s, the balloon's bearing, the antenna's azimuth, rad. */
  var track: Vector[(Double, Double, Double)] = Vector.empty

  val instruments: Instruments = Instruments(() => answered(bearingRad), () => answered(azimuthRad), turn)

  /** Appends the current bearing and azimuth to the track. */
  def watch(): Unit = synchronized:
    track :+= (elapsedS, bearingRad, azimuthRad)

  private def elapsedS = clock.now().since(start).toSeconds

  /** Bearing of the balloon, rad: it passes 100 m away at 5 m/s. */
  private def bearingRad = StrictMath.atan2(5 * (elapsedS - 20), 100)

  private def azimuthRad = azimuth + rateRadS * clock.now().since(turnedAt).toSeconds

  private def answered(value: => Double): Future[Either[String, Double]] = synchronized:
    val delay = 20 + random.nextInt(180)
    if random.nextInt(20) == 0 then after(500.millis)(Future.successful(Left("no answer within 500 ms")))
    else
      val measured = value
      after(delay.millis)(Future.successful(Right(measured)))

  private def turn(rate: Double): Future[Boolean] =
    after(30.millis)(Future.unit).flatMap: _ =>
      synchronized:
        azimuth = azimuthRad
        turnedAt = clock.now()
        rateRadS = rate
        moving.trySuccess(false)
        moving = Promise()
        if rate == 0 then Future.successful(true) else moving.future
