//! The first words of a client on a stream.

use std::borrow::Cow;

use rmcp::RoleServer;
use rmcp::model::{ClientJsonRpcMessage, ClientRequest, GetMeta, ProtocolVersion, ServerJsonRpcMessage};
use rmcp::transport::Transport;

/// A stream on which nothing but requests count until one of them settles the version of the protocol. What else comes
/// before, such as the cancellation of a probe, concerns nobody any more; the service would end over it.
pub(super) struct Opening<T> {
    stream: T,
    versions: Cow<'static, [ProtocolVersion]>,
    version: Version,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    Open,
    Settled,
}

impl<T> Opening<T> {
    /// The stream of a service that speaks these versions.
    pub(super) fn of(stream: T, versions: Cow<'static, [ProtocolVersion]>) -> Self {
        Self { stream, versions, version: Version::Open }
    }

    /// Whether a request settles the version: an `initialize`, or one that stands on its own and is no probe.
    fn settles(&self, request: &ClientRequest) -> bool {
        let meta = request.get_meta();
        match request {
            ClientRequest::InitializeRequest(_) => true,
            ClientRequest::DiscoverRequest(_) | ClientRequest::PingRequest(_) => false,
            _ => {
                meta.missing_required_keys(&ProtocolVersion::V_2026_07_28).is_empty()
                    && meta.protocol_version().is_some_and(|version| self.versions.contains(&version))
            }
        }
    }
}

impl<T: Transport<RoleServer>> Transport<RoleServer> for Opening<T> {
    type Error = T::Error;

    fn send(
        &mut self,
        message: ServerJsonRpcMessage,
    ) -> impl Future<Output = Result<(), Self::Error>> + Send + 'static {
        self.stream.send(message)
    }

    async fn receive(&mut self) -> Option<ClientJsonRpcMessage> {
        loop {
            let message = self.stream.receive().await?;
            match &message {
                _ if self.version == Version::Settled => return Some(message),
                ClientJsonRpcMessage::Request(request) => {
                    if self.settles(&request.request) {
                        self.version = Version::Settled;
                    }
                    return Some(message);
                }
                _ => tracing::debug!("a message before the first request is passed over"),
            }
        }
    }

    async fn close(&mut self) -> Result<(), Self::Error> {
        self.stream.close().await
    }
}
