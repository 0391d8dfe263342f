package skein.vtime.agent;

/** A scheduler whose actor system admits one thread only. */
public interface Guard {

  /**
   * Called on the sender's thread before a message enters an actor's mailbox; throws if the thread is outside
   * virtual time.
   */
  void delivered();
}
