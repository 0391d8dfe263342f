package skein.lanes.timetable

import skein.forward.{DelayTable, Delays, RolloutAgent, Engagement, TabledDelays, Vehicle, VelocityResponse}
import skein.fusion.SensorModel
import skein.policy.{Action, Assignment, KeepHeading, Role}
import skein.vehicle.SensorNoise

/** Vehicles at rest, used to compute the times of a loop, which do not depend on positions. */
private[lanes] object StandingStill:
  /** An engagement of this number of vehicles. Roles and rivals are arbitrary, since they have no effect on
    * times.
    *
    * @param eyes cameras of vehicles in a duel, indexed by vehicle
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
    * @param handsOverS value of [[VelocityResponse.handoverS]]
    * @param noise decides which readings are missing
    */
  final class Response(handsOverS: Double = 0, noise: Option[SensorNoise] = None) extends VelocityResponse:
    override def handoverS: Double            = handsOverS
    override def sensors: Option[SensorNoise] = noise
    def create(): Vehicle                     = new Vehicle:
      def start(x: Double, y: Double, z: Double): Unit = ()
      def act(action: Action): Unit                    = ()
      def advance(timeS: Double): Unit                 = ()
      def x: Double                                    = 0
      def y: Double                                    = 0
      def z: Double                                    = 0
      def vx: Double                                   = 0
      def vy: Double                                   = 0

  /** The link of the flight whose times are being computed. Mutable. */
  final class Link extends Delays:
    var delays: TabledDelays = DelayTable.none

    def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
      delays.delayNs(worldKey, line, step, number, sentAtNs)
