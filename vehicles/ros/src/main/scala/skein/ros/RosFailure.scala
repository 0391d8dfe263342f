package skein.ros

/** A failed call of ROS 2's library, with the library's reason; [[RosNode]] returns it as a value. */
private[ros] final class RosFailure(message: String) extends Exception(message)
