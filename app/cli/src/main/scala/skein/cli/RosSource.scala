package skein.cli

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Future, blocking}
import skein.flight.VehicleSource
import skein.loop.LoopKind
import skein.policy.Action
import skein.ros.{RosFleet, RosNode, TwistCommand}
import skein.settings.{FlySettings, Wire}
import skein.units.{Clock, Expect}
import skein.vehicle.{Guidance, VehicleKind}

/** The vehicles of `./skein fly --ros`: those behind ROS 2's topics.
  *
  * @param remappings topics' remappings, by ROS's rules
  */
private[cli] final class RosSource(remappings: Seq[String], clock: Clock)(using system: ActorSystem)
    extends VehicleSource:
  import system.dispatcher

  val where: String = "ROS 2"

  override def guidance: Action => Guidance = TwistCommand.guidance

  def open(names: Vector[String]): Future[Either[String, VehicleSource.Opened]] =
    RosFleet
      .open(names, remappings, clock)
      .map(_.map: fleet =>
        VehicleSource.Opened(
          fleet.vehicles,
          () => fleet.vehicles.head.clocks,
          () =>
            Future:
              blocking(fleet.close())
              fleet.node.notes.foreach(line => Console.err.println(s"ROS 2: $line"))
              Done
        ))

private[cli] object RosSource:
  /** Why flights with these settings cannot use vehicles behind ROS 2's topics, if they cannot. */
  def mistake(settings: FlySettings, isLive: Boolean, hasSimulator: Boolean): Option[String] =
    val paused = settings.loops.contains(LoopKind.Paused)
    val cars   = settings.fleet.agents.filter(_.kind == VehicleKind.Car).map(_.name)
    val others = settings.links.filter(_.bandwidth.isDefined)
    val all    =
      for
        _ <- Expect.that(
          !hasSimulator && settings.wire == Wire.AirSim
        )("not together with --simulator or --mavlink")
        _ <- Expect.that(isLive)("expected --clock real, since other programs' nodes run by it")
        _ <-
          Expect.that(!paused)("expected loops other than paused, whose simulator stands still between steps")
        _ <- Expect.that(others.isEmpty):
          s"expected links without a rate, since messages have no known size, got ${others.map(_.name).mkString(", ")}"
        _ <- Expect.that(cars.isEmpty)(s"expected multirotors alone, got the car ${cars.mkString(", ")}")
        _ <- Expect.that(settings.images.isEmpty)("expected no --images")
        _ <- Expect.that(!settings.decentralised)("not together with --decentralised")
        _ <- Expect.that(settings.scene.isEmpty && settings.plant.isAirSim && settings.sensors.isEmpty):
          "--scene, --plant and --sensors are for the built-in simulator"
        _ <- RosNode.missing.toLeft(())
      yield ()
    all.left.toOption.map("--ros: " + _)
