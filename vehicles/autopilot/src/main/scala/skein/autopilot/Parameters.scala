package skein.autopilot

import skein.mavlink.{Message, ParamValue}

/** An autopilot's parameters, by PX4's names and with PX4's defaults. */
final case class Parameters(values: Map[String, Double] = Parameters.defaults):
  import Parameters.*

  def apply(parameter: Parameter): Double = values(parameter.name)

  def all: Vector[Message] = known.map(message)

  /** The message for one parameter: by its name, or by its index if that is not negative. */
  def one(name: String, index: Int): Option[Message] =
    (if index >= 0 then known.lift(index) else known.find(_.name == name)).map(message)

  /** @param value as encoded in a message: the bits of an integer
    * @return the changed parameters and the answer; Left says why it is refused
    */
  def set(name: String, value: Float): Either[String, (Parameters, Message)] =
    known.find(_.name == name) match
      case None            => Left(s"unknown param: $name")
      case Some(parameter) =>
        val number =
          if parameter.isInteger then java.lang.Float.floatToRawIntBits(value).toDouble else value.toDouble
        if !(number >= parameter.least && number <= parameter.most) then
          Left(s"$name: expected ${parameter.least} to ${parameter.most}")
        else
          val next = copy(values.updated(name, number))
          Right((next, next.message(parameter)))

  private def message(parameter: Parameter): Message =
    val number = apply(parameter)
    val value  =
      if parameter.isInteger then java.lang.Float.intBitsToFloat(number.toInt) else number.toFloat
    ParamValue(
      parameter.name,
      value,
      if parameter.isInteger then Int32 else Real32,
      known.size,
      parameter.ordinal
    )

/** A parameter with its default and range.
  *
  * @param name PX4's name
  * @param default the default value, in the unit of PX4's reference
  */
enum Parameter(
    val name: String,
    val default: Double,
    val least: Double,
    val most: Double,
    val isInteger: Boolean = false
):
  /** Height of a takeoff, m above the ground. */
  case TakeoffAltitude extends Parameter("MIS_TAKEOFF_ALT", 2.5, 0.5, 500)

  /** Speeds of flights to positions, of takeoff and of landing, m/s. */
  case Cruise       extends Parameter("MPC_XY_CRUISE", 5, 0.5, 20)
  case TakeoffSpeed extends Parameter("MPC_TKO_SPEED", 1.5, 0.3, 5)
  case LandSpeed    extends Parameter("MPC_LAND_SPEED", 0.7, 0.2, 2)

  /** Height at which the vehicle returns, m above home. */
  case ReturnAltitude extends Parameter("RTL_RETURN_ALT", 30, 0, 500)

  /** A waypoint is reached within this distance, m. */
  case AcceptanceRadius extends Parameter("NAV_ACC_RAD", 2, 0.2, 200)

  /** Time after the last setpoint at which offboard ends, s. */
  case OffboardLoss extends Parameter("COM_OF_LOSS_T", 1, 0.1, 60)

  /** Time after which the vehicle disarms when it has landed, or was armed and did not take off, s; negative:
    * never.
    */
  case DisarmLanded    extends Parameter("COM_DISARM_LAND", 2, -1, 20)
  case DisarmPreflight extends Parameter("COM_DISARM_PRFLT", 10, -1, 600)

  /** Has no effect; ground stations read it. */
  case Airframe extends Parameter("SYS_AUTOSTART", 4001, 4001, 4001, isInteger = true)

object Parameters:
  private val Int32  = 6
  private val Real32 = 9

  export Parameter.*

  val known: Vector[Parameter] = Parameter.values.toVector

  private val defaults: Map[String, Double] = known.map(one => one.name -> one.default).toMap
