package skein.vehicle

/** A quadrotor in X: its body, rotors and drag. The defaults are AirSim 1.8's generic quadrotor
  * (`MultiRotorParams::setupFrameGenericQuad`, `RotorParams`).
  *
  * Rotors, in this order: 0 front right (counter-clockwise), 1 rear left (counter-clockwise), 2 front left
  * (clockwise), 3 rear right (clockwise). They lie in one plane on the diagonals.
  *
  * @param massKg total mass, motors included
  * @param motorKg mass of one motor, a point at its rotor
  * @param boxFrontM length of the body box along front; `boxRightM` and `boxDownM` likewise
  * @param armM distance from the centre of mass to a rotor's axis, in the rotor plane
  * @param rotorDownM the rotor plane's down coordinate in the body
  * @param rotorDiameterM diameter of a rotor: a GWS 9×5 propeller
  * @param rotorHeightM height of the cylinder that the rotor sweeps, which has drag sideways
  * @param maxThrustN thrust of one rotor at full control and sea-level density: C_T ρ n² D⁴ with C_T 0.109919
  *   at 6396.667 rpm
  * @param maxTorqueNm torque of one rotor likewise: C_P ρ n² D⁵ / 2π with C_P 0.040164
  * @param rotorTimeConstantS time constant of the first-order lag from control to thrust
  * @param dragCoefficient coefficient of drag: a quarter of a blunt body's 1.3, for a streamlined frame
  * @param dragMinSpeed minimum speed with drag, m/s: a face that moves more slowly along its normal has none
  * @param restitution share of the normal speed that remains after a bounce
  * @param friction share of the tangential speed that is lost in a bounce
  */
final case class Airframe(
    massKg: Double = 1.0,
    motorKg: Double = 0.055,
    boxFrontM: Double = 0.180,
    boxRightM: Double = 0.110,
    boxDownM: Double = 0.040,
    armM: Double = 0.2275,
    rotorDownM: Double = 0.025,
    rotorDiameterM: Double = 0.2286,
    rotorHeightM: Double = 0.01,
    maxThrustN: Double = 4.179446268,
    maxTorqueNm: Double = 0.0555618,
    rotorTimeConstantS: Double = 0.005,
    dragCoefficient: Double = 1.3 / 4,
    dragMinSpeed: Double = 0.1,
    restitution: Double = 0.55,
    friction: Double = 0.5
):
  require(massKg > 4 * motorKg, s"mass $massKg kg must exceed that of four motors, ${4 * motorKg} kg")

  /** Distance of every rotor from the front axis and from the right axis, m. */
  val rotorOffsetM: Double = armM * math.sqrt(0.5)

  private val boxKg = massKg - 4 * motorKg

  /** Moments of inertia about front, right and down, kg·m²: a box (m/12·(b² + c²)) plus four point masses. */
  val inertiaFront: Double = boxKg / 12 * (square(boxRightM) + square(boxDownM)) + motors(rotorDownM)
  val inertiaRight: Double = boxKg / 12 * (square(boxFrontM) + square(boxDownM)) + motors(rotorDownM)
  val inertiaDown: Double  = boxKg / 12 * (square(boxFrontM) + square(boxRightM)) + motors(rotorOffsetM)

  private val discM2  = 4 * math.Pi * square(rotorDiameterM)
  private val sidesM2 = 4 * math.Pi * rotorDiameterM * rotorHeightM

  /** Drag over density and squared normal speed of the faces across front, right and down, m². AirSim puts
    * π·D² of each rotor (not a disc's π·D²/4) into the top and bottom faces.
    */
  val dragFront: Double = dragCoefficient / 2 * (boxRightM * boxDownM + sidesM2)
  val dragRight: Double = dragCoefficient / 2 * (boxFrontM * boxDownM + sidesM2)
  val dragDown: Double  = dragCoefficient / 2 * (boxFrontM * boxRightM + discM2)

  private def motors(acrossM: Double) = 4 * motorKg * (square(rotorOffsetM) + square(acrossM))
  private def square(x: Double)       = x * x

object Airframe:
  /** Standard gravity, m/s²: AirSim's below 10 km. */
  val Gravity = 9.80665
