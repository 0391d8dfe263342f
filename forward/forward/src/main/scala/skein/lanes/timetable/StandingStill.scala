package skein.lanes.timetable

import skein.forward.{DelayTable, Delays, RolloutAgent, Engagement, TabledDelays, Vehicle, VelocityResponse}
import skein.fusion.SensorModel
import skein.policy.{Action, Assignment, KeepHeading, Role}

/** Vehicles at rest, to compute a loop's times, which do not depend on positions. */
private[lanes] object StandingStill:
  /** This number of vehicles; roles and rivals do not affect times.
    *
    * @param eyes of vehicles with cameras, in a duel
    */
  def engagement(vehicles: Int, durationS: Double, eyes: Map[Int, SensorModel] = Map.empty): Engagement =
    Engagement(
      Vector.tabulate(vehicles)(self => RolloutAgent(0, 0, 0, 0, 0, KeepHeading, eyes.get(self))),
      Role.Evader +: Vector.fill(vehicles - 1)(Role.Pursuer),
      Assignment(Vector.tabulate(vehicles)(self => Vector(if self == 0 then 1 else 0))),
      durationS
    )

  /** The response of vehicles at rest.
    *
    * @param handsOverS see [[VelocityResponse.handoverS]]
    */
  final class Response(handsOverS: Double = 0) extends VelocityResponse:
    override def handoverS: Double = handsOverS
    def create(): Vehicle          = new Vehicle:
      def start(x: Double, y: Double, z: Double): Unit = ()
      def act(action: Action): Unit                    = ()
      def advance(timeS: Double): Unit                 = ()
      def x: Double                                    = 0
      def y: Double                                    = 0
      def z: Double                                    = 0
      def vx: Double                                   = 0
      def vy: Double                                   = 0

  /** The link of the flight whose times are computed. Mutable. */
  final class Link extends Delays:
    var delays: TabledDelays = DelayTable.none

    def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
      delays.delayNs(worldKey, line, step, number, sentAtNs)
