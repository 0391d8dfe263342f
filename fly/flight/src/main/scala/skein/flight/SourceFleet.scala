package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.policy.Fleet
import skein.port.VehicleError
import skein.units.{Clock, Vector3}

/** A scenario's vehicles of a [[VehicleSource]], brought to their starts over the flight's own connection.
  *
  * @param calledOff why vehicles must no longer move to their starts
  */
private[flight] final class SourceFleet(
    source: VehicleSource,
    fleet: Fleet,
    clock: Clock,
    calledOff: () => Option[String]
)(using system: ActorSystem):
  import system.dispatcher

  /** Connects, and completes when all vehicles hover at their starts. */
  def connect(opened: Opened): Future[ConnectedFleet] =
    source.open(fleet.agents.map(_.name)).flatMap:
      case Left(reason) => Future.failed(CannotFly(s"${source.where}: $reason"))
      case Right(open)  =>
        opened.closing(open)(_.close()): Unit
        val starts = fleet.agents.zip(open.vehicles).map: (agent, vehicle) =>
          StartPositioning.Starting(
            agent.startPositionNed,
            Approach(agent.name, vehicle, clock, calledOff),
            // The vehicle climbs vertically to its layer from its present position.
            () => vehicle.read().map(_.fold(cannot, _.value.positionNed))
          )
        StartPositioning
          .fly(starts)
          .recoverWith { case StartPositioning.NotReady(reason) => Future.failed(CannotFly(reason)) }
          .map: _ =>
            ConnectedFleet(
              open.vehicles,
              None,
              source.where,
              () => open.vehicles.head.read().map(_.isRight),
              () => Future.successful(Right(None)),
              clocks = open.clocks()
            )

  private def cannot(error: VehicleError): Vector3 = throw StartPositioning.NotReady(error.message)
