package skein.flight

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.policy.Fleet
import skein.units.Clock

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
    for
      open <- CannotFly.unless(source.open(fleet.agents.map(_.name)))(reason => s"${source.where}: $reason")
      _      = opened.closing(open)(_.close())
      starts = fleet.agents.zip(open.vehicles).map: (agent, vehicle) =>
        StartPositioning.Starting(
          agent.startPositionNed,
          Approach(agent.name, vehicle, clock, calledOff),
          // The vehicle climbs vertically to its layer from its present position.
          () => CannotFly.unless(vehicle.read())(_.message).map(_.value.positionNed)
        )
      _ <- StartPositioning.fly(starts)
    yield ConnectedFleet(
      open.vehicles,
      None,
      source.where,
      () => open.vehicles.head.read().map(_.isRight),
      () => Future.successful(Right(None)),
      clocks = open.clocks()
    )
