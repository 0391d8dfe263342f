package skein.simulator

import skein.airsim.wire.{CarControls, CarState}

/** Functions of cars that AirSim's `CarClient` has in addition to the functions of all vehicles. */
private[simulator] object CarMethods extends MethodList:
  import ServerMethod.*

  many[(CarControls, String)]("setCarControls"):
    case (simulation, (controls, name)) =>
      car(simulation, name)((_, car) => done(car.setControls(controls)))
  read("getCarControls", car)((car, _) => car.controls)
  one[String]("getCarState"): (simulation, name) =>
    car(simulation, name): (_, car) =>
      val seen = VehicleMethods.sensed(simulation, car)
      answer(CarState(
        car.speedMps.toFloat,
        car.gear,
        car.rpm.toFloat,
        SimulatedCar.MostRpm.toFloat,
        car.controls.handbrake,
        VehicleMethods.kinematics(seen),
        seen.at,
        seen.isMissing
      ))
