package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.forecast.{Estimate, Forecast}
import skein.units.*

/** Predicts vehicles' states at the time when a command sent now will act. */
object Predict:

  /** Joins to each element the estimates of [[Forecast.whenActing]], in the order of the vehicles, and
    * compares earlier estimates with the readings received since.
    *
    * '''Emits when''' an element arrives whose forecast has a reading of every vehicle. '''Backpressures
    * when''' downstream backpressures. '''Completes when''' upstream completes. '''Cancels when''' downstream
    * cancels.
    *
    * @param verified selects the vehicles whose estimates are compared with readings
    * @param lead time from the element's arrival until its command is sent, or begins to act; evaluated at
    *   each element
    * @param onVerified called for every prediction that a later reading verifies, with its error
    */
  def whenActing[A](clock: Clock, verified: Int => Boolean = _ => true, lead: => Span = Span.Zero)(
      onVerified: Verified => Unit
  ): Flow[(A, Forecast), (A, Vector[Estimate]), NotUsed] =
    Flow[(A, Forecast)]
      .statefulMap(() => Unverified.none)(
        { case (unverified, (element, forecast)) =>
          val now          = clock.now()
          val (left, held) = unverified.heldAgainst(forecast)
          held.foreach(onVerified)
          forecast.whenActing(now + lead) match
            case Some(estimates) => (left.withMade(now, estimates, verified), Some((element, estimates)))
            case None            => (left, None)
        },
        _ => None
      )
      .collect { case Some(ahead) => ahead }

/** A prediction and its error, in three dimensions. */
final case class Verified(vehicle: Int, madeAt: Instant, estimate: Estimate, error: Metres)

/** Predictions that no reading has verified yet, without those that no later reading can verify. */
final case class Unverified private (made: Vector[Unverified.Made]):
  import Unverified.*

  /** @param of selects vehicles by their index among the estimates */
  def withMade(at: Instant, estimates: Vector[Estimate], of: Int => Boolean): Unverified =
    val more =
      for (estimate, vehicle) <- estimates.zipWithIndex if of(vehicle)
      yield Made(vehicle, at, estimate)
    Unverified((made ++ more).takeRight(Limit * estimates.size))

  /** Compares predictions with a forecast's readings; returns the remaining ones and the verified ones. */
  def heldAgainst(forecast: Forecast): (Unverified, Vector[Verified]) =
    val (waiting, due) = made.partition(one =>
      forecast.tracks(one.vehicle).forall(_.newest.validAt < one.estimate.predictedFor)
    )
    val verified =
      for
        Made(vehicle, at, estimate) <- due
        track                       <- forecast.tracks(vehicle)
        positionNed                 <- track.positionNedAt(estimate.predictedFor)
      yield Verified(vehicle, at, estimate, Metres((estimate.kinematics.positionNed - positionNed).norm))
    (Unverified(waiting), verified)

object Unverified:
  val none: Unverified = Unverified(Vector.empty)

  /** Maximum number of one vehicle's unverified predictions. */
  val Limit = 32

  final case class Made private[Unverified] (vehicle: Int, at: Instant, estimate: Estimate)
