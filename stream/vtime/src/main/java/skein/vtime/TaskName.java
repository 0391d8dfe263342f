package skein.vtime;

import org.apache.pekko.dispatch.Mailbox;
import org.apache.pekko.dispatch.TaskInvocation;

/** Names tasks and actors for reports. In Java, because Scala may not look into Pekko's mailboxes. */
final class TaskName {
  private TaskName() {}

  /** The actor's path where the task is an actor's mailbox, else the class of what runs. */
  static String of(Runnable task) {
    return switch (task) {
      case Mailbox mailbox when mailbox.actor() != null -> mailbox.actor().self().path().toString();
      case TaskInvocation invocation -> of(invocation.runnable());
      default -> task.getClass().getName();
    };
  }
}
