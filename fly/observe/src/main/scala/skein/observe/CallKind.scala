package skein.observe

/** The purpose of a call of AirSim's interface, for a loop's timing. */
enum CallKind(val label: String):
  case State extends CallKind("state")

  case Sensor extends CallKind("sensors")

  case Image extends CallKind("images")

  /** Commands a vehicle; answered when the move ends or a newer one replaces it. */
  case Move extends CallKind("moves")

  /** Pauses, steps or continues the simulator. */
  case Time extends CallKind("time")

  case Other extends CallKind("other")

object CallKind:
  private val states = Set(
    "getMultirotorState",
    "getCarState",
    "simGetGroundTruthKinematics",
    "simGetVehiclePose",
    "simGetObjectPose"
  )

  private val sensors = Set(
    "getImuData",
    "getBarometerData",
    "getMagnetometerData",
    "getGpsData",
    "getDistanceSensorData",
    "getLidarData",
    "getRotorStates"
  )

  private val images = Set("simGetImages", "simGetImage", "simGetDetections")
  private val times  = Set("simPause", "simContinueForTime", "simContinueForFrames")
  private val moves  = Set("hover", "takeoff", "land", "goHome", "moveOnPath", "setCarControls")

  def of(method: String): CallKind =
    if states(method) then State
    else if sensors(method) then Sensor
    else if images(method) then Image
    else if times(method) then Time
    else if moves(method) || method.startsWith("moveBy") || method.startsWith("moveTo") ||
      method.startsWith("rotateTo") || method.startsWith("rotateBy")
    then Move
    else Other
