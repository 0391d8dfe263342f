package skein.simulator

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import scala.util.Using
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.hil.AutopilotKind
import skein.link.{Address, TcpTransport}
import skein.signal.Kinematics
import skein.units.*

/** The result of a flight in which Betaflight flies a vehicle to 5 m height and holds the position.
  *
  * @param isArmed whether Betaflight could be armed
  * @param worstM greatest distance from the position while it was to be held
  * @param updatesPerS motor updates meanwhile, at most one for each state: 500 in a second of the simulator's
  *   clock
  * @param longestPauseS longest time between two of them, on the simulator's clock
  * @param track the vehicle's positions, a line every 0.2 s of the simulator's clock
  */
private final case class BetaflightFlight(
    isArmed: Boolean,
    worstM: Double,
    updatesPerS: Double,
    longestPauseS: Double,
    track: String
):
  override def toString: String =
    f"armed: $isArmed; at most $worstM%.3f m from its place, $updatesPerS%.0f updates " +
      f"of its motors a second, ${longestPauseS * 1000}%.0f ms between two"

private object BetaflightFlight:
  /** Flies with the firmware through the interface of `serve --hil betaflight`.
    *
    * @param holdsS time for which the position is held, on the simulator's clock
    * @param speed rate of the simulator's clock relative to the real one
    */
  def fly(firmware: Path, holdsS: Double, speed: Double)(using ActorSystem): BetaflightFlight =
    val folder = Files.createTempDirectory("betaflight")
    Betaflight.configure(firmware, folder)
    val process = Betaflight.start(firmware, folder)
    try
      val settings = SimulatorSettings(
        WorldSettings(Vector(VehicleSettings("one"))),
        Address("127.0.0.1", 0),
        speed = speed,
        hil = Some(HilSettings.usual(AutopilotKind.Betaflight, 1))
      )
      val server = Await.result(SimulatorServer.start(settings, TcpTransport(), Clock.system), 10.seconds)
      try
        Using.resource(RemoteControl())(
          Flight(_, () => Await.result(server.truth(), 5.seconds), speed).fly(holdsS)
        )
      finally
        val _ = Await.result(server.close(), 10.seconds)
    finally
      val _ = process.destroyForcibly().waitFor()

  private final class Flight(control: RemoteControl, look: () => SimulatorServer.Truth, speed: Double):
    private val goal     = Vector3(0, 0, -5)
    private val pilot    = StickPilot(goal)
    private val began    = look().at
    private val track    = StringBuilder()
    private var nextNote = 0.0

    def fly(holdsS: Double): BetaflightFlight =
      // A switch that is on at first does not arm it.
      val isArmed = (1 to 30).exists: _ =>
        during(0.5)((_, _) => control.move(0, 0, 0, 0, arms = false))
        during(0.5)((_, _) => control.move(0, 0, 0, 0, arms = true))
        control.isArmed
      if isArmed then during(RisesS)(hold)
      val before = control.updates
      control.longestPauseNanos = 0
      var worst = if isArmed then 0.0 else goal.norm
      if isArmed then
        during(holdsS): (seen, dtS) =>
          worst = worst.max((seen.positionNed - goal).norm)
          hold(seen, dtS)
      BetaflightFlight(
        isArmed,
        worst,
        (control.updates - before) / holdsS,
        control.longestPauseNanos * 1e-9 * speed,
        track.toString
      )

    private def hold(seen: Kinematics, dtS: Double): Unit =
      val (roll, pitch, throttle, yaw) = pilot.sticks(seen, dtS)
      control.move(roll, pitch, throttle, yaw, arms = true)

    private def during(lastsS: Double)(move: (Kinematics, Double) => Unit): Unit =
      def upS(truth: SimulatorServer.Truth) = truth.at.since(began).toSeconds
      var truth                             = look()
      var before                            = upS(truth)
      val end                               = before + lastsS
      while before < end do
        val seen = truth.vehicles.head.kinematics
        val now  = upS(truth)
        note(now, seen)
        move(seen, now - before)
        before = now
        Thread.sleep((PeriodMs / speed).round)
        truth = look()

    private def note(now: Double, seen: Kinematics): Unit = if now >= nextNote then
      nextNote = now + 0.2
      val (at, v, turn) = (seen.positionNed, seen.velocityNed, seen.orientation)
      track ++= f"$now%.2f s: at ${at.x}%.2f ${at.y}%.2f ${at.z}%.2f m, ${v.x}%.2f " +
        f"${v.y}%.2f ${v.z}%.2f m/s, roll ${turn.rollRad}%.3f, pitch " +
        f"${turn.pitchRad}%.3f, yaw ${turn.yawRad}%.3f rad, ${control.updates} updates\n"

  private val RisesS   = 10.0
  private val PeriodMs = 10.0
