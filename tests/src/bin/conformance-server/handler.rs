//! The home's service with the fixtures beside its own tools, prompts and resources.
#![expect(deprecated, reason = "the suite also judges what newer revisions have left behind")]

use std::sync::Arc;

use coin_server::service::CoinService;
use rmcp::model::{
    CallToolRequestParams, CallToolResponse, CallToolResult, CompleteRequestParams, CompleteResult,
    ContentBlock, CustomRequest, CustomResult, GetPromptRequestParams, GetPromptResponse, GetPromptResult,
    ListPromptsResult, ListResourceTemplatesResult, ListResourcesResult, ListToolsResult,
    PaginatedRequestParams, PromptMessage, ReadResourceRequestParams, ReadResourceResponse,
    ReadResourceResult, Reference, RequestStateCodec, Role, ServerConfig, SetLevelRequestParams,
    SubscribeRequestParams, SubscriptionFilter, Tool, UnsubscribeRequestParams,
};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer, ServerHandler};
use serde_json::json;

use crate::content::{self, tool};
use crate::dialogue::{self, Stand};
use crate::questions;

/// Whatever is no fixture goes to the home.
#[derive(Clone)]
pub(crate) struct WithFixtures {
    home: CoinService,
    codec: Arc<RequestStateCodec>,
}

impl WithFixtures {
    pub(crate) fn new(home: CoinService) -> Self {
        let codec = RequestStateCodec::try_new(vec![7; 32]).expect("the key is long enough");
        Self { home, codec: Arc::new(codec) }
    }
}

type Context = RequestContext<RoleServer>;

impl ServerHandler for WithFixtures {
    fn get_info(&self) -> ServerConfig {
        let mut info = self.home.get_info();
        info.capabilities.logging = Some(content::of(json!({})));
        if let Some(resources) = &mut info.capabilities.resources {
            resources.subscribe = Some(true);
        }
        info
    }

    async fn list_tools(
        &self,
        request: Option<PaginatedRequestParams>,
        context: Context,
    ) -> Result<ListToolsResult, ErrorData> {
        let mut list = self.home.list_tools(request, context).await?;
        list.tools.extend(content::tools());
        list.tools.extend(questions::tools());
        list.tools.extend(dialogue::TOOLS.map(|name| tool(name, json!({"type": "object"}))));
        Ok(list)
    }

    fn get_tool(&self, name: &str) -> Option<Tool> {
        self.home.get_tool(name)
    }

    async fn call_tool(
        &self,
        request: CallToolRequestParams,
        context: Context,
    ) -> Result<CallToolResponse, ErrorData> {
        if let Some(result) = content::answer(&request.name) {
            return Ok(result.into());
        }
        let arguments = request.arguments.clone().unwrap_or_default();
        if let Some(result) = questions::call(&request.name, &arguments, &context).await {
            return result.map(Into::into);
        }
        let Some(dialogue) = dialogue::of(&request.name) else {
            return self.home.call_tool(request, context).await;
        };
        let able = context.client_capabilities().unwrap_or_default();
        let (state, brought) = (request.request_state.as_deref(), request.input_responses.as_ref());
        Ok(match dialogue.go_on(&self.codec, &able, state, brought)? {
            Stand::Asks(result) => result.into(),
            Stand::Ends { said } => CallToolResult::success(vec![ContentBlock::text(said)]).into(),
        })
    }

    async fn list_prompts(
        &self,
        request: Option<PaginatedRequestParams>,
        context: Context,
    ) -> Result<ListPromptsResult, ErrorData> {
        let mut list = self.home.list_prompts(request, context).await?;
        list.prompts.extend(content::prompts());
        list.prompts
            .push(content::of(json!({"name": dialogue::PROMPT, "description": "Asks for its context."})));
        Ok(list)
    }

    async fn get_prompt(
        &self,
        request: GetPromptRequestParams,
        context: Context,
    ) -> Result<GetPromptResponse, ErrorData> {
        let arguments = request.arguments.clone().unwrap_or_default();
        if let Some(result) = content::prompt(&request.name, &arguments) {
            return Ok(result.into());
        }
        let Some(dialogue) = dialogue::of(&request.name).filter(|_| request.name == dialogue::PROMPT) else {
            return self.home.get_prompt(request, context).await;
        };
        let able = context.client_capabilities().unwrap_or_default();
        let (state, brought) = (request.request_state.as_deref(), request.input_responses.as_ref());
        Ok(match dialogue.go_on(&self.codec, &able, state, brought)? {
            Stand::Asks(result) => result.into(),
            Stand::Ends { said } => {
                GetPromptResult::new(vec![PromptMessage::new_text(Role::User, said)]).into()
            }
        })
    }

    async fn list_resources(
        &self,
        request: Option<PaginatedRequestParams>,
        context: Context,
    ) -> Result<ListResourcesResult, ErrorData> {
        let mut list = self.home.list_resources(request, context).await?;
        list.resources.extend(content::of::<Vec<_>>(content::resources()));
        Ok(list)
    }

    async fn list_resource_templates(
        &self,
        request: Option<PaginatedRequestParams>,
        context: Context,
    ) -> Result<ListResourceTemplatesResult, ErrorData> {
        let mut list = self.home.list_resource_templates(request, context).await?;
        list.resource_templates.extend(content::of::<Vec<_>>(content::templates()));
        Ok(list)
    }

    async fn read_resource(
        &self,
        request: ReadResourceRequestParams,
        context: Context,
    ) -> Result<ReadResourceResponse, ErrorData> {
        match content::resource(&request.uri) {
            Some(content) => Ok(ReadResourceResult::new(vec![content]).into()),
            None => self.home.read_resource(request, context).await,
        }
    }

    /// Values of the suite's own prompt are not completed; of the home's they are.
    async fn complete(
        &self,
        request: CompleteRequestParams,
        context: Context,
    ) -> Result<CompleteResult, ErrorData> {
        match &request.r#ref {
            Reference::Prompt(prompt) if prompt.name.starts_with("test_") => Ok(CompleteResult::default()),
            _ => self.home.complete(request, context).await,
        }
    }

    /// Nothing here ever changes, so that there is nothing to tell a client that listens.
    fn accepted_subscription_filter(&self, requested: &SubscriptionFilter) -> Option<SubscriptionFilter> {
        Some(requested.clone())
    }

    async fn subscribe(&self, _: SubscribeRequestParams, _: Context) -> Result<(), ErrorData> {
        Ok(())
    }

    async fn unsubscribe(&self, _: UnsubscribeRequestParams, _: Context) -> Result<(), ErrorData> {
        Ok(())
    }

    async fn set_level(&self, _: SetLevelRequestParams, _: Context) -> Result<(), ErrorData> {
        Ok(())
    }

    async fn on_custom_request(
        &self,
        request: CustomRequest,
        context: Context,
    ) -> Result<CustomResult, ErrorData> {
        self.home.on_custom_request(request, context).await
    }
}
