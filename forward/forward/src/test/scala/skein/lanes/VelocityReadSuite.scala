package skein.lanes

import skein.lanes.policy.TeamLanes
import skein.policy.*
import skein.signal.Kinematics
import skein.units.*

/** Kernels compute velocities only if a policy reads one. */
class VelocityReadSuite extends munit.FunSuite:
  import VelocityReadSuite.*

  private def needsVelocity(policy: Policy): Boolean =
    TeamLanes
      .of(Vector(policy, Place), Assignment(Vector(Vector(1), Vector(0))), isPredicted = false)
      .fold(throw _, _.needsVelocity)

  test("a policy that reads one component of a velocity needs velocities"):
    assert(needsVelocity(North))
    assert(needsVelocity(East))

  test("a policy that reads only positions needs no velocities"):
    assert(!needsVelocity(Place))

object VelocityReadSuite:
  /** Flies along a heading that is a component of its opponent's reading. */
  abstract class Reads extends Policy:
    type Memory = Unit
    def read(rival: Kinematics): Double
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      (Action.Along(Radians(read(seen.vehicles(seen.opponent).kinematics)), seen.cruise, seen.startDown), ())

  case object North extends Reads:
    def read(rival: Kinematics): Double = rival.velocityNed.x

  case object East extends Reads:
    def read(rival: Kinematics): Double = rival.velocityNed.y

  case object Place extends Reads:
    def read(rival: Kinematics): Double = rival.positionNed.x + rival.positionNed.y
