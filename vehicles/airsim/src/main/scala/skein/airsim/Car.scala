package skein.airsim

import scala.concurrent.{ExecutionContext, Future}
import skein.airsim.wire.{CarControls as WireControls, CarState}
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.CarControls
import upickle.default.writeMsg

/** One car of a simulator. Controls take effect immediately and hold until the next; they are sent in order
  * on one connection.
  */
final class Car(
    client: AirSimClient,
    name: String,
    originNed: Vector3 = Vector3.Zero,
    connectionKey: Int = 0
) extends VehicleClient(client, name, originNed, connectionKey):
  private given ExecutionContext = ExecutionContext.parasitic

  def status(): Future[Either[RpcError, Stamped[CarStatus]]] = stateOf("getCarState"): (state: CarState) =>
    val status = CarStatus(
      inWorld(state.kinematics_estimated),
      MetresPerSecond(state.speed),
      state.gear,
      state.rpm,
      state.handbrake,
      state.skein_missing
    )
    (status, state.timestamp)

  /** Sets pedals and steering. Has no effect without API control.
    *
    * @param gear chosen by hand: −1 is reverse; None: AirSim's gearbox chooses
    */
  def setControls(
      controls: CarControls,
      handbrake: Boolean = false,
      gear: Option[Int] = None
  ): Future[Either[RpcError, Unit]] =
    val told = WireControls(
      controls.throttle.toFloat,
      controls.steering.toFloat,
      controls.brake.toFloat,
      handbrake,
      gear.isDefined,
      gear.getOrElse(0)
    )
    call[upack.Msg]("setCarControls", Seq(writeMsg(told)), inOrder).map(_.map(_ => ()))

  def over(client: AirSimClient, originNed: Vector3, connectionKey: Int): Car =
    Car(client, name, originNed, connectionKey)

object Car:

  /** The car of this name; its origin is read from the simulator's settings. */
  def named(client: AirSimClient, name: String): Future[Either[AirSimError, Car]] =
    VehicleClient.named(client, name, Car(client, name, _, _))

/** A car's state.
  *
  * @param speed along its heading, negative in reverse
  * @param gear −1 is reverse
  */
final case class CarStatus(
    kinematics: Kinematics,
    speed: MetresPerSecond,
    gear: Int,
    rpm: Double,
    handbrake: Boolean,
    isMissing: Boolean = false
) extends VehicleStatus
