package skein.forward

import skein.policy.Action
import skein.vehicle.{SensorNoise, VehicleModel}

/** Vehicles whose readings have errors, each vehicle in each world its own. */
final case class SensedResponse(of: VelocityResponse, noise: SensorNoise) extends VelocityResponse:
  def create(): Vehicle = of.create()

  override def handoverS: Double            = of.handoverS
  override def isSpatial: Boolean           = of.isSpatial
  override def performs: Action => Boolean  = of.performs
  override def regardsYaw: Boolean          = of.regardsYaw
  override def sensors: Option[SensorNoise] = Some(noise)
  override def predictor: VehicleModel[?]   = of.predictor

  private[skein] override def body: VelocityResponse = of.body

  private[skein] override def predictorUnder(loop: VehicleModel[?]): VehicleModel[?] = of.predictorUnder(loop)
