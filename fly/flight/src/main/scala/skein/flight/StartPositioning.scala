package skein.flight

import scala.concurrent.{ExecutionContext, Future}
import skein.units.Vector3

/** Flies vehicles to their starts, all at once, so that no way crosses another at one altitude: from wherever
  * they are, each first climbs straight to a layer of its own, above all starts, and crosses over in it when
  * all have come to theirs; when all have crossed over, they go down.
  */
private[flight] object StartPositioning:
  /** A vehicle on its way to its start, world NED.
    *
    * @param leaveGround takes off where it stands, and says where it is then; fails with [[NotReady]]
    */
  final case class Starting(startNed: Vector3, approach: Approach, leaveGround: () => Future[Vector3])

  /** Carries an expected error out of a chain of calls. */
  final case class NotReady(reason: String) extends RuntimeException(reason)

  /** From one vehicle's layer to the next, m: more than a vehicle passes its goal by. */
  private val LayerM = 5.0

  /** Until all are at rest and look north; fails with [[NotReady]]. */
  def fly(vehicles: Vector[Starting])(using ExecutionContext): Future[Unit] =
    val highest = vehicles.map(_.startNed.z).min
    val layered = vehicles.zipWithIndex.map((vehicle, index) => (vehicle, highest - (index + 1) * LayerM))
    for
      _ <- Future.traverse(layered)((one, down) =>
        one.leaveGround().flatMap(above => go(one, above.copy(z = down), Approach.Passing))
      )
      _ <- Future.traverse(layered)((one, down) => go(one, one.startNed.copy(z = down), Approach.Passing))
      _ <- Future.traverse(vehicles)(one => go(one, one.startNed, Approach.AtRest))
    yield ()

  private def go(one: Starting, goalNed: Vector3, limits: Approach.Limits)(using
      ExecutionContext
  ): Future[Unit] =
    one.approach.to(goalNed, limits).map(_.fold(reason => throw NotReady(reason), _ => ()))
