package antenna

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import skein.flow.*
import skein.units.*

/** Two instruments that answer late, sometimes never: the balloon's bearing and the antenna's azimuth; and
  * the motor.
  *
  * @param bearing of the balloon, rad
  * @param azimuth of the antenna, rad
  * @param turn turns the antenna at a rate, rad/s; answers when the command has been replaced by the next
  */
final case class Instruments(
    bearing: () => Future[Either[String, Double]],
    azimuth: () => Future[Either[String, Double]],
    turn: Double => Future[Boolean]
)

/** Keeps an antenna pointed at a balloon. No drone, no simulator: the operators work with any source of data.
  */
object Antenna:
  private val period    = Span.ofMillis(200)
  private val gainPerS  = 1.5
  private val mostRadPs = 0.5

  /** The policy: turn in proportion to the error, no faster than the motor can. */
  def rate(bearingRad: Double, azimuthRad: Double): Double =
    val errorRad = StrictMath.IEEEremainder(bearingRad - azimuthRad, 2 * math.Pi)
    (gainPerS * errorRad).max(-mostRadPs).min(mostRadPs)

  /** The loop as a graph: senses two instruments, joins their values, decides, and commands the motor.
    *
    * @param note called for every lost answer
    */
  def track(instruments: Instruments, clock: Clock, duration: Span, note: String => Unit)(using
      ActorSystem
  ): Future[Done] =
    def sense(name: String, ask: () => Future[Either[String, Double]]): Source[(String, Double), ?] =
      Sense
        .every(period)(ask)(
          onSkip = lost => note(s"$name: ${lost.fold(identity, _ => "overtaken")}"),
          onMissed = ticks => note(s"$name: $ticks questions missed")
        )
        .map((name, _))
    val both = sense("bearing", instruments.bearing).merge(sense("azimuth", instruments.azimuth))
    both
      .takeWithin(duration.toDuration)
      .via(JoinLatest(
        Set("bearing", "azimuth"),
        patience = period / 4
      )(isNewer = (_, _) => true, onStale = (_, _) => ()))
      .via(Pace(period / 2, clock)(_ => ()))
      .map(newest => rate(newest("bearing"), newest("azimuth")))
      .via(Steer(minInterval = period / 2, clock)(send = instruments.turn, park = () => instruments.turn(0)))
      .runWith(Sink.ignore)
