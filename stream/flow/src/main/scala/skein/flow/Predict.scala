package skein.flow

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.forecast.{Estimate, Forecast}
import skein.units.*

/** Predicts the states of vehicles for the moment at which a command sent now will act. */
object Predict:

  /** Joins to each element the estimates of [[Forecast.whenActing]], in the order of the vehicles, and
    * compares earlier estimates with the readings that have come since.
    *
    * '''Emits when''' an element arrives by whose forecast every vehicle was seen. '''Backpressures when'''
    * downstream backpressures. '''Completes when''' upstream completes. '''Cancels when''' downstream
    * cancels.
    *
    * @param verified vehicles whose estimates are compared with readings
    * @param lead how much later than the element's coming its command will be sent, or begin to act; asked
    *   for at each element
    * @param onVerified called for every prediction whose moment was read, with its error
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

/** A prediction and how far it was off, horizontally and vertically together. */
final case class Verified(vehicle: Int, madeAt: Instant, estimate: Estimate, error: Metres)

/** Predictions whose moment was not read yet; those that never can be are forgotten. */
final case class Unverified private (made: Vector[Unverified.Made]):
  import Unverified.*

  /** @param of vehicles, by their place among the estimates
    */
  def withMade(at: Instant, estimates: Vector[Estimate], of: Int => Boolean): Unverified =
    val more =
      for (estimate, vehicle) <- estimates.zipWithIndex if of(vehicle)
      yield Made(vehicle, at, estimate)
    Unverified((made ++ more).takeRight(Limit * estimates.size))

  /** What is left, and the predictions that a forecast's readings verify. */
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

  /** Predictions of one vehicle that may wait. */
  val Limit = 32

  final case class Made private[Unverified] (vehicle: Int, at: Instant, estimate: Estimate)
