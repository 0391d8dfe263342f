package skein.ros.message

/** Bytes that are not the expected message; the text says what was expected, what was found and where. */
private[message] final class CdrError(message: String) extends Exception(message, null, false, false)
