package skein.vehicle

/** Memory of a [[TunedFlightController]] for one vehicle. Mutable. */
final private[vehicle] class CascadeMemory:
  import CascadeLoop.*

  val integral: Array[Double] = new Array(Count)
  val error: Array[Double]    = new Array(Count)

  private val created = new Array[Boolean](Count)

  private var horizontal: HorizontalMode | Null = null
  private var vertical: VerticalMode | Null     = null
  private var yaw: YawMode | Null               = null

  def isNew(loop: Int): Boolean = created(loop)

  /** Starts an update, and resets the controllers of axes whose mode has changed. */
  def begin(setpoint: Setpoint): Unit =
    note(setpoint.horizontal ne horizontal, CascadeMemory.Horizontal)
    note(setpoint.vertical ne vertical, CascadeMemory.Vertical)
    note(setpoint.yaw ne yaw, CascadeMemory.Yaw)
    horizontal = setpoint.horizontal
    vertical = setpoint.vertical
    yaw = setpoint.yaw

  def copy: CascadeMemory =
    val other = CascadeMemory()
    integral.copyToArray(other.integral)
    error.copyToArray(other.error)
    created.copyToArray(other.created)
    other.horizontal = horizontal
    other.vertical = vertical
    other.yaw = yaw
    other

  private def note(changed: Boolean, loops: Array[Int]): Unit =
    for loop <- loops do
      created(loop) = changed
      if changed then
        integral(loop) = 0
        error(loop) = 0

private object CascadeMemory:
  import CascadeLoop.*
  private[vehicle] val Horizontal =
    Array(
      RollRate,
      PitchRate,
      RollAngle,
      PitchAngle,
      RightVelocity,
      FrontVelocity,
      NorthPosition,
      EastPosition
    )
  private[vehicle] val Vertical = Array(DownPosition, DownVelocity)
  private[vehicle] val Yaw      = Array(YawRate, YawAngle)

private[vehicle] object CascadeLoop:
  /** Indices of the cascade's controllers, without that of the vertical velocity, whose integral is in
    * [[QuadrotorState]].
    */
  inline val RollRate      = 0
  inline val PitchRate     = 1
  inline val YawRate       = 2
  inline val RollAngle     = 3
  inline val PitchAngle    = 4
  inline val YawAngle      = 5
  inline val RightVelocity = 6
  inline val FrontVelocity = 7
  inline val NorthPosition = 8
  inline val EastPosition  = 9
  inline val DownPosition  = 10
  inline val DownVelocity  = 11
  inline val Count         = 12
