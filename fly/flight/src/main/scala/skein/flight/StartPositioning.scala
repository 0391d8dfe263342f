package skein.flight

import scala.concurrent.{ExecutionContext, Future}
import skein.units.Vector3

/** Moves vehicles to their starts, all simultaneously, without crossing paths at one altitude: each first
  * climbs vertically to its own layer, above all starts, and crosses over in it when all are in theirs; when
  * all have crossed over, they descend.
  */
private[flight] object StartPositioning:
  /** A vehicle on its way to its start, world NED.
    *
    * @param leaveGround takes off vertically, and returns the position reached; fails with [[CannotFly]]
    */
  final case class Starting(startNed: Vector3, approach: Approach, leaveGround: () => Future[Vector3])

  /** Distance between two vehicles' layers, m: more than a vehicle's overshoot. */
  val LayerM = 5.0

  /** Moves vehicles until all are at rest and look north; fails with [[CannotFly]].
    *
    * @param team the whole team. Each vehicle has a layer of its own, also if other processes move the others
    * @param moves selects the vehicles to move, by index
    */
  def fly(team: Vector[Starting], moves: Int => Boolean = _ => true)(using ExecutionContext): Future[Unit] =
    lazy val highest = team.map(_.startNed.z).min
    val layered      = team.zipWithIndex.collect:
      case (vehicle, index) if moves(index) => (vehicle, highest - (index + 1) * LayerM)
    for
      _ <- Future.traverse(layered)((one, down) =>
        one.leaveGround().flatMap(above => one.approach.to(above.copy(z = down), Approach.Passing))
      )
      _ <- Future.traverse(layered)((one, down) =>
        one.approach.to(one.startNed.copy(z = down), Approach.Passing)
      )
      _ <- Future.traverse(layered)((one, _) => one.approach.to(one.startNed, Approach.AtRest))
    yield ()
