package skein.autopilot

import skein.mavlink.*
import skein.policy.{ActionGuidance, Yaw}
import skein.units.*
import skein.units.Decimals.fixed
import skein.vehicle.{GoTo, Setpoint}

/** A setpoint from outside the autopilot, for offboard mode. */
enum OffboardSetpoint:
  /** For each axis a position, a velocity, both or neither, in the vehicle's own frame. With both, the
    * vehicle flies to the position with the velocity added.
    *
    * @param inBody whether the velocity is front, right and down
    */
  case Move(
      north: Option[Double],
      east: Option[Double],
      down: Option[Double],
      velocity: (Option[Double], Option[Double], Option[Double]),
      inBody: Boolean,
      yaw: Yaw
  )

  /** Attitude with a thrust; thrust is a fraction of full thrust. */
  case Attitude(rollRad: Double, pitchRad: Double, yawRad: Double, thrust: Double)

  /** Body rates with a thrust; thrust is a fraction of full thrust. */
  case Rates(rollRadps: Double, pitchRadps: Double, yawRadps: Double, thrust: Double)

object OffboardSetpoint:
  /** Reads a setpoint from a message.
    *
    * @param home the origin of the vehicle's own frame
    * @return None if it is not a setpoint; Left says why it is refused
    */
  def of(message: Message, home: GeoLocation): Option[Either[String, OffboardSetpoint]] = message match
    case one: SetPositionTargetLocalNed =>
      import CommonDialect.Frame.*
      val frame = one.coordinateFrame
      Some(
        if !Set(LocalNed, BodyNed, BodyFrd).contains(frame) then
          Left(s"SET_POSITION_TARGET_LOCAL_NED: coordinate frame $frame unsupported")
        else
          val inBody = frame != LocalNed
          val places = Vector(one.x, one.y, one.z)
          val speeds = Vector(one.vx, one.vy, one.vz)
          val move   = moveOf(places.map(_.toDouble), speeds, one.typeMask, inBody, one.yaw, one.yawRate)
          if inBody && move.exists(_.hasPlace) then Left("a place in the body's frame is unsupported")
          else move
      )
    case one: SetPositionTargetGlobalInt =>
      heightOf(one.coordinateFrame, one.alt, home) match
        case None =>
          Some(Left(s"SET_POSITION_TARGET_GLOBAL_INT: coordinate frame ${one.coordinateFrame} unsupported"))
        case Some(altitude) =>
          val (latitude, longitude) = (one.latInt * 1e-7, one.lonInt * 1e-7)
          val at                    = GeoLocation(latitude, longitude, altitude).nedFrom(home)
          val hasPlace              = (one.typeMask & (CommonDialect.Ignore.X | CommonDialect.Ignore.Y)) == 0
          val away                  = awayM(latitude, longitude, home)
          Some(
            if hasPlace && away > Most then
              Left(s"setpoint: ${(away / 1000).fixed(0)} km from home (OriginGeopoint)")
            else
              moveOf(
                Vector(at.x, at.y, at.z),
                Vector(one.vx, one.vy, one.vz),
                one.typeMask,
                inBody = false,
                one.yaw,
                one.yawRate
              )
          )
    case one: SetAttitudeTarget =>
      val q       = one.q.map(_.toDouble)
      val byRates = (one.typeMask & IgnoreAttitude) != 0
      val rates   = Vector(one.bodyRollRate, one.bodyPitchRate, one.bodyYawRate).map(_.toDouble)
      val numbers = one.thrust.toDouble +: (if byRates then rates else q)
      def isTurn  = q.size == 4 && math.abs(q.map(x => x * x).sum - 1) < 0.1
      if !numbers.forall(number => math.abs(number) <= MostTurnRadPerS) || !(byRates || isTurn) then
        Some(Left("SET_ATTITUDE_TARGET: no attitude that can be flown"))
      else
        val thrust = numbers.head.max(0).min(1)
        Some(Right(
          if byRates then Rates(rates(0), rates(1), rates(2), thrust)
          else
            val turn = Quaternion(q(0), q(1), q(2), q(3))
            Attitude(turn.rollRad, turn.pitchRad, turn.yawRad, thrust)
        ))
    case _ => None

  /** Altitude above the sea, m, of an altitude in one of the supported frames. */
  private[autopilot] def heightOf(frame: Int, altitudeM: Double, home: GeoLocation): Option[Metres] =
    import CommonDialect.Frame.*
    if frame == Global || frame == GlobalInt then Some(Metres(altitudeM))
    else if frame == RelativeAltitude || frame == RelativeAltitudeI then
      Some(Metres(home.altitude.value + altitudeM))
    else None

  /** Distance over the ground from home to a position, m, on a sphere. */
  private[autopilot] def awayM(latitudeDeg: Double, longitudeDeg: Double, home: GeoLocation): Double =
    val (from, to) = (math.toRadians(home.latitudeDeg), math.toRadians(latitudeDeg))
    val north      = StrictMath.sin((to - from) / 2)
    val east       = StrictMath.sin(math.toRadians(longitudeDeg - home.longitudeDeg) / 2)
    val chord      = north * north + StrictMath.cos(from) * StrictMath.cos(to) * east * east
    2 * GeoLocation.EarthRadiusM * StrictMath.asin(math.sqrt(chord.min(1)))

  /** Lines for a sender whose position is too far away: the vehicle's home, and how to set it. */
  private[autopilot] def whereHomeIs(home: GeoLocation): Vector[String] = Vector(
    s"home is ${home.latitudeDeg.fixed(6)}, ${home.longitudeDeg.fixed(6)}",
    "OriginGeopoint in settings.json sets home"
  )

  private val IgnoreAttitude = 128

  /** Maximum position coordinate, m, and maximum speed, m/s, that a setpoint may have. */
  private[autopilot] val Most = 1e5

  /** Maximum turn rate that a setpoint may have. */
  private val MostTurnRadPerS = 100.0

  private def moveOf(
      places: Vector[Double],
      speeds: Vector[Float],
      mask: Int,
      inBody: Boolean,
      yaw: Float,
      yawRate: Float
  ): Either[String, OffboardSetpoint.Move] =
    import CommonDialect.Ignore
    def asked(value: Double, bit: Int) = Option.when((mask & bit) == 0 && !value.isNaN)(value)
    val place                          = places.zip(Seq(Ignore.X, Ignore.Y, Ignore.Z)).map(asked)
    val velocity = speeds.map(_.toDouble).zip(Seq(Ignore.Vx, Ignore.Vy, Ignore.Vz)).map(asked)
    val turn     = asked(yaw, Ignore.Yaw)
    val rate     = asked(yawRate, Ignore.YawRate)
    val numbers  = (place ++ velocity :+ turn :+ rate).flatten
    if (place ++ velocity).flatten.isEmpty then
      Left("setpoint: expected a position or a velocity, got neither")
    else if numbers.exists(number => !(math.abs(number) <= Most)) then
      Left("setpoint: expected finite numbers, got others")
    else
      val heading = turn.map(rad => Yaw.Towards(Radians(rad)))
      Right(OffboardSetpoint.Move(
        place(0),
        place(1),
        place(2),
        (velocity(0), velocity(1), velocity(2)),
        inBody,
        heading.orElse(rate.map(Yaw.Turning(_))).getOrElse(Yaw.Still)
      ))

  extension (move: OffboardSetpoint.Move)
    private def hasPlace = (move.north ++ move.east ++ move.down).nonEmpty

  /** Converts a target to a setpoint of the flight controller.
    *
    * @param cruise the maximum speed towards positions
    */
  def setpoint(target: OffboardSetpoint, motion: VehicleMotion, cruise: MetresPerSecond): Setpoint =
    target match
      case Attitude(roll, pitch, yaw, thrust) => Setpoint.anglesThrottle(roll, pitch, yaw, thrust)
      case Rates(roll, pitch, yaw, thrust)    => Setpoint.ratesThrottle(roll, pitch, yaw, thrust)
      case move: Move                         =>
        val state        = motion.state
        val (vn, ve, vd) = move.velocity
        val asked        = Vector3(vn.getOrElse(0), ve.getOrElse(0), vd.getOrElse(0))
        val heading      = Quaternion.ofYaw(state.orientation.yawRad)
        val velocity     = if move.inBody then heading.toWorld(asked) else asked
        val goal         = Vector3(
          move.north.getOrElse(state.positionNed.x),
          move.east.getOrElse(state.positionNed.y),
          move.down.getOrElse(state.positionNed.z)
        )
        val towards = GoTo.velocityNed(state.positionNed, state.velocityNed, goal, cruise)
        val north   = velocity.x + move.north.fold(0.0)(_ => towards.x)
        val east    = velocity.y + move.east.fold(0.0)(_ => towards.y)
        // By velocity in the plane and at an altitude: what the flight controller does by itself.
        val byPlane  = move.north.isEmpty && move.east.isEmpty && vd.isEmpty
        val setpoint = move.down match
          case Some(down) if byPlane => Setpoint.velocityZ(north, east, down)
          case Some(_)               => Setpoint.velocity(north, east, velocity.z + towards.z)
          case None                  => Setpoint.velocity(north, east, velocity.z)
        ActionGuidance.turned(setpoint, move.yaw, Vector3.Zero)
