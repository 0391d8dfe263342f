package skein.ros

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.Future
import scala.concurrent.duration.DurationInt
import skein.units.{Clock, Expect}

/** Vehicles behind the topics of one node, in the order of their names.
  *
  * @param node counts refused messages, and notes the reasons
  */
final class RosFleet private (val node: RosNode, val vehicles: Vector[RosVehicle]):

  /** Lets all vehicles hover, and ends the node. */
  def close(): Unit =
    vehicles.foreach(_.close())
    node.close()

object RosFleet:
  private val Within = 15.seconds

  /** Opens a node and waits until odometry of every vehicle has arrived for 3 s, by which their clocks are
    * known.
    *
    * @param remappings such as `/a/odom:=/uav1/odometry`
    * @return Left if ROS 2 is not installed, or lists the vehicles without odometry
    */
  def open(names: Vector[String], remappings: Seq[String], clock: Clock)(using
      system: ActorSystem
  ): Future[Either[String, RosFleet]] =
    import system.dispatcher
    val opened =
      for
        _        <- SimulatedTopics.mistake(names).toLeft(())
        node     <- RosNode.open("skein_fly", clock, remappings)
        vehicles <- Expect.each(names)(RosVehicle.open(node, _, clock)).left.map: why =>
          node.close()
          why
      yield RosFleet(node, vehicles)
    opened match
      case Left(why)    => Future.successful(Left(why))
      case Right(fleet) =>
        val all  = Future.sequence(fleet.vehicles.map(_.isThere)).map(_ => ())
        val late = after(Within)(Future.unit)
        Future
          .firstCompletedOf(Seq(all, late))
          .flatMap: _ =>
            val missing =
              names.zip(fleet.vehicles).collect { case (name, one) if !one.isThere.isCompleted => name }
            if missing.isEmpty then after(ClocksAfter)(Future.successful(Right(fleet)))
            else
              fleet.close()
              Future.successful(Left(
                s"expected odometry on ${missing.map(name => s"/$name/odom").mkString(", ")} within " +
                  s"${Within.toSeconds} s, none arrived${fleet.node.notes.map("; " + _).mkString}"
              ))

  private val ClocksAfter = 3.seconds
