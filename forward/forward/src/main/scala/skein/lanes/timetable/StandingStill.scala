package skein.lanes.timetable

import skein.forward.{DelayTable, Delays, RolloutAgent, Engagement, TabledDelays, Vehicle, VelocityResponse}
import skein.fusion.SensorModel
import skein.policy.{Assignment, KeepHeading, Role}

/** Vehicles that stand still: by them a loop tells its times, which do not depend on where vehicles are. */
private[lanes] object StandingStill:
  /** So many vehicles; their roles and rivals decide no time.
    *
    * @param eyes of vehicles that see, in a duel
    */
  def engagement(vehicles: Int, durationS: Double, eyes: Map[Int, SensorModel] = Map.empty): Engagement =
    Engagement(
      Vector.tabulate(vehicles)(self => RolloutAgent(0, 0, 0, 0, 0, KeepHeading, eyes.get(self))),
      Role.Evader +: Vector.fill(vehicles - 1)(Role.Pursuer),
      Assignment(Vector.tabulate(vehicles)(self => Vector(if self == 0 then 1 else 0))),
      durationS
    )

  /** @param handsOverS see [[VelocityResponse.handoverS]] */
  final class Response(handsOverS: Double = 0) extends VelocityResponse:
    override def handoverS: Double = handsOverS
    def create(): Vehicle          = new Vehicle:
      def start(x: Double, y: Double, z: Double): Unit = ()
      def command(vx: Double, vy: Double): Unit        = ()
      def advance(timeS: Double): Unit                 = ()
      def x: Double                                    = 0
      def y: Double                                    = 0
      def vx: Double                                   = 0
      def vy: Double                                   = 0

  /** The link of the flight whose times are told. Mutable. */
  final class Link extends Delays:
    var delays: TabledDelays = DelayTable.none

    def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
      delays.delayNs(worldKey, line, step, number, sentAtNs)
