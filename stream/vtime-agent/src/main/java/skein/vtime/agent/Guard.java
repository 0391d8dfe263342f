package skein.vtime.agent;

/** A scheduler whose actor system admits one thread only. */
public interface Guard {

  /**
   * Called on the sender's thread before a message enters an actor's mailbox; throws if that thread is
   * foreign.
   */
  void delivered();
}
