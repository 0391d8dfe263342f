package skein.ros

/** A call of ROS 2's library that failed, with its own words; [[RosNode]] hands it on as a value. */
private[ros] final class RosFailure(message: String) extends Exception(message)
